// Portrait photos that carry their depth: Google's GDepth in the XMP data of a JPEG
// (https://developers.google.com/depthmap-metadata/reference).

const XMP = 'http://ns.adobe.com/xap/1.0/\0';
const EXTENDED = 'http://ns.adobe.com/xmp/extension/\0';
/** In front of an extended part: the identifier, the length of all parts, and the offset of this one. */
const [IDENTIFIER, LENGTH, OFFSET] = [32, 4, 4];

/** Returns the XMP data of a JPEG as text; empty without any. @param {ArrayBuffer} bytes */
function metadata(bytes) {
  const [view, all] = [new DataView(bytes), new Uint8Array(bytes)];
  if (all.length < 4 || view.getUint16(0) !== 0xffd8) return '';
  const text = (part) => new TextDecoder('latin1').decode(part);
  let main = '';
  const parts = [];
  for (let at = 2; at + 4 <= all.length && all[at] === 0xff && all[at + 1] !== 0xda;) {
    const end = at + 2 + view.getUint16(at + 2);
    const payload = all.subarray(at + 4, end);
    if (all[at + 1] === 0xe1 && text(payload.subarray(0, XMP.length)) === XMP) main = text(payload.subarray(XMP.length));
    if (all[at + 1] === 0xe1 && text(payload.subarray(0, EXTENDED.length)) === EXTENDED) {
      const content = EXTENDED.length + IDENTIFIER + LENGTH + OFFSET;
      parts.push({ offset: view.getUint32(at + 4 + content - OFFSET), text: text(payload.subarray(content)) });
    }
    at = end;
  }
  return main + parts.sort((a, b) => a.offset - b.offset).map((part) => part.text).join('');
}

const decode = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

/** Returns the depth as a PNG of a size, 0 near to 1 far as a depth buffer has it. */
async function depthBuffer(depth, [width, height], { linear, near, far }) {
  const paint = new OffscreenCanvas(width, height).getContext('2d');
  paint.drawImage(await createImageBitmap(depth), 0, 0, width, height);
  const image = paint.getImageData(0, 0, width, height);
  for (let i = 0; i < image.data.length; i += 4) {
    const share = image.data[i] / 255;
    const distance = near + share * (far - near);
    const value = linear ? (far * (distance - near)) / (distance * (far - near)) : share;
    image.data.fill(Math.round(value * 255), i, i + 3);
  }
  paint.putImageData(image, 0, 0);
  return (await paint.canvas.convertToBlob({ type: 'image/png' })).arrayBuffer();
}

/**
 * Returns colour and depth of a photo, and the values of the options' fields; null if it carries no depth.
 * @param {{name: string, bytes: ArrayBuffer}} file
 */
export async function photo({ name, bytes }) {
  const text = metadata(bytes);
  const value = (key) => new RegExp(`${key}(?:="|>)([^"<]*)`).exec(text)?.[1];
  const data = value('GDepth:Data');
  if (!data) return null;
  const [near, far] = ['GDepth:Near', 'GDepth:Far'].map((key) => Number(value(key)));
  if (!(near > 0 && far > near)) throw new Error(`${name} carries a depth without its nearest and farthest distance.`);
  // The picture before its background was blurred, if the photo has it.
  const original = value('GImage:Data');
  const color = original ? decode(original).buffer : bytes;
  const shown = await createImageBitmap(new Blob([color]), { imageOrientation: 'none' });
  const depth = await depthBuffer(
    new Blob([decode(data)]), [shown.width, shown.height], { linear: value('GDepth:Format') === 'RangeLinear', near, far });
  return {
    pair: { color: { name, bytes: color }, depth: { name: 'its depth.png', bytes: depth } },
    known: { source: 'center', encoding: 'standard-z', near, far },
  };
}
