// Quality of pictures, as `yoro-metrics` defines it.

/** PSNR over RGB in dB. */
export function psnr(a, b) {
  let sum = 0;
  for (let i = 0; i < a.data.length; i++) if (i % 4 < 3) sum += (a.data[i] - b.data[i]) ** 2;
  return sum === 0 ? 99 : 10 * Math.log10(255 ** 2 * a.data.length * 0.75 / sum);
}

const KERNEL = Array.from({ length: 11 }, (_, i) => Math.exp(-0.5 * ((i - 5) / 1.5) ** 2));
const TOTAL = KERNEL.reduce((sum, weight) => sum + weight);

function blurred(values, width, height) {
  const pass = (from, step, isInside) => Float64Array.from(from, (_, i) => {
    if (!isInside(i)) return 0;
    let sum = 0;
    for (let k = 0; k < 11; k++) sum += KERNEL[k] * from[i + (k - 5) * step];
    return sum / TOTAL;
  });
  const column = (i) => i % width, row = (i) => Math.floor(i / width);
  const rows = pass(values, 1, (i) => column(i) >= 5 && column(i) < width - 5);
  return pass(rows, width, (i) => row(i) >= 5 && row(i) < height - 5);
}

/** SSIM of luma, in windows of 11 x 11 pixels. */
export function ssim(a, b) {
  const { width, height } = a;
  const [x, y] = [a, b].map(({ data }) => Float64Array.from({ length: width * height }, (_, i) => 0.299 * data[4 * i] + 0.587 * data[4 * i + 1] + 0.114 * data[4 * i + 2]));
  const [mx, my, xx, yy, xy] = [x, y, x.map((v) => v * v), y.map((v) => v * v), x.map((v, i) => v * y[i])].map((values) => blurred(values, width, height));
  const [c1, c2] = [2.55 ** 2, 7.65 ** 2];
  let sum = 0, count = 0;
  for (let r = 5; r < height - 5; r++) {
    for (let i = r * width + 5; i < (r + 1) * width - 5; i++) {
      const m = mx[i] * my[i];
      sum += (2 * m + c1) * (2 * (xy[i] - m) + c2) / ((mx[i] ** 2 + my[i] ** 2 + c1) * (xx[i] - mx[i] ** 2 + yy[i] - my[i] ** 2 + c2));
      count++;
    }
  }
  return sum / count;
}
