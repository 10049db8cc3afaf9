// Compiles all modules, and draws a picture with the passes between parallel eyes. Returns the browser's messages and the
// pixels, or null without WebGPU.
async ({ modules, uniforms, color, depth, source, target, tiles, spans }) => {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) return null;
  const device = await adapter.requestDevice();
  device.pushErrorScope("validation");
  const says = [];
  const made = {};
  for (const [name, code] of Object.entries(modules)) {
    made[name] = device.createShaderModule({ label: name, code });
    const { messages } = await made[name].getCompilationInfo();
    says.push(...messages.map((message) => `${name}:${message.lineNum}: ${message.message}`));
  }

  const texture = (format, size, bytes) => {
    const usage = GPUTextureUsage;
    const drawn = usage.TEXTURE_BINDING | usage.RENDER_ATTACHMENT | usage.COPY_SRC | usage.COPY_DST;
    const made = device.createTexture({ format, size, usage: drawn });
    if (bytes) device.queue.writeTexture({ texture: made }, bytes, { bytesPerRow: 4 * size[0] }, size);
    return made;
  };
  const block = device.createBuffer({ size: uniforms.length, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(block, 0, new Uint8Array(uniforms));
  const bound = {
    0: [{ texture: { sampleType: "unfilterable-float" } }, texture("r32float", source, new Float32Array(depth)).createView()],
    1: [{ texture: {} }, texture("rgba8unorm", source, new Uint8Array(color)).createView()],
    4: [{ buffer: {} }, { buffer: block }],
    5: [{ sampler: { type: "non-filtering" } }, device.createSampler()],
    6: [{ sampler: {} }, device.createSampler({ magFilter: "linear", minFilter: "linear" })],
  };
  const encoder = device.createCommandEncoder();
  const pass = (vertex, fragment, format, size, bindings) => {
    const visibility = GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT;
    const layout = device.createBindGroupLayout({
      entries: bindings.map((binding) => ({ binding, visibility, ...bound[binding][0] })),
    });
    const pipeline = device.createRenderPipeline({
      layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
      vertex: { module: made[vertex] },
      fragment: { module: made[fragment], targets: [{ format }] },
    });
    const into = texture(format, size);
    const view = into.createView();
    const recorded = encoder.beginRenderPass({ colorAttachments: [{ view, loadOp: "clear", storeOp: "store" }] });
    recorded.setPipeline(pipeline);
    const entries = bindings.map((binding) => ({ binding, resource: bound[binding][1] }));
    recorded.setBindGroup(0, device.createBindGroup({ layout, entries }));
    recorded.draw(3);
    recorded.end();
    return into;
  };
  const map = (made) => [{ texture: { sampleType: "uint" } }, made.createView()];
  bound[2] = map(pass("screen", "tiles", "rgba32uint", tiles, [0, 4, 5]));
  bound[3] = map(pass("screen", "spans", "rgba32uint", spans, [2, 4]));
  const drawn = pass("march-vertex", "march", "rgba8unorm", target, [0, 1, 2, 3, 4, 5, 6]);

  const [width, height] = target;
  const bytesPerRow = Math.ceil(width / 64) * 256;
  const buffer = device.createBuffer({ size: bytesPerRow * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  encoder.copyTextureToBuffer({ texture: drawn }, { buffer, bytesPerRow }, target);
  device.queue.submit([encoder.finish()]);
  const error = await device.popErrorScope();
  if (error) says.push(error.message);
  await buffer.mapAsync(GPUMapMode.READ);
  const bytes = new Uint8Array(buffer.getMappedRange());
  const rows = Array.from({ length: height }, (_, y) => Array.from(bytes.slice(y * bytesPerRow, y * bytesPerRow + 4 * width)));
  return { adapter: `${adapter.info.vendor} ${adapter.info.architecture}`, says, rgba: rows.flat() };
}
