// Portrait photos that carry their depth: Google's GDepth in the XMP data of a JPEG
// (https://developers.google.com/depthmap-metadata/reference), or Dynamic Depth, whose XMP data lists the files that
// follow the JPEG (https://developer.android.com/training/camera2/Dynamic-depth-v1.0.pdf).

const XMP = 'http://ns.adobe.com/xap/1.0/\0';
const EXTENDED = 'http://ns.adobe.com/xmp/extension/\0';
/** The bytes in front of an extended part: the identifier, the length of all parts, and the offset of this one. */
const [IDENTIFIER, LENGTH, OFFSET] = [32, 4, 4];

/** Returns the XMP data of a JPEG as text, which is empty if it has none. @param {ArrayBuffer} bytes */
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

/** Returns the depth as a PNG of the given size, from 0 (near) to 1 (far) as in a depth buffer. */
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
 * Returns the files that Dynamic Depth's directory lists, by their address.
 * @param {string} text @param {ArrayBuffer} bytes
 * @returns {Map<string, ArrayBuffer>}
 */
function listed(text, bytes) {
  const items = text.split(/<rdf:li|<Container:Item/).map((part) => {
    const value = (key) => new RegExp(`Item:${key}(?:="|>)([^"<]*)`).exec(part)?.[1];
    return { address: value('DataURI') ?? value('Semantic') ?? '', length: Number(value('Length') ?? 0) };
  });
  const found = new Map();
  // They are stored one after the other at the end of the file.
  let end = bytes.byteLength;
  for (const { address, length } of items.filter((item) => item.length > 0).reverse()) {
    found.set(address, bytes.slice(Math.max(0, end - length), end));
    end -= length;
  }
  return found;
}

/**
 * Returns what a photo says about its depth and, if it has it, the picture before its background was blurred. Returns
 * null if the photo has no depth.
 * @param {string} text @param {ArrayBuffer} bytes
 */
function carried(text, bytes) {
  const value = (key) => new RegExp(`${key}(?:="|>)([^"<]*)`).exec(text)?.[1];
  const data = value('GDepth:Data');
  const kind = data ? 'GDepth' : 'DepthMap';
  const files = data ? null : listed(text, bytes);
  const [depth, original] = data
    ? [decode(data).buffer, value('GImage:Data') && decode(value('GImage:Data')).buffer]
    : [files.get(value('DepthMap:DepthURI') ?? 'Depth'), files.get(value('Image:ItemURI') ?? 'Original')];
  const [near, far] = ['Near', 'Far'].map((key) => Number(value(`${kind}:${key}`)));
  return depth ? { depth, original, near, far, linear: value(`${kind}:Format`) === 'RangeLinear' } : null;
}

/**
 * Returns the colour and the depth of a photo, and the values of the options' fields. Returns null if the photo has no
 * depth.
 * @param {{name: string, bytes: ArrayBuffer}} file
 */
export async function photo({ name, bytes }) {
  const found = carried(metadata(bytes), bytes);
  if (!found) return null;
  const { original, near, far, linear } = found;
  if (!(near > 0 && far > near)) throw new Error(`${name} carries a depth without its nearest and farthest distance.`);
  const color = original ?? bytes;
  const shown = await createImageBitmap(new Blob([color]), { imageOrientation: 'none' });
  const depth = await depthBuffer(new Blob([found.depth]), [shown.width, shown.height], { linear, near, far })
    .catch(() => { throw new Error(`${name} carries a depth that cannot be decoded.`); });
  return {
    pair: { color: { name, bytes: color }, depth: { name: 'its depth.png', bytes: depth } },
    known: { source: 'center', encoding: 'standard-z', near, far },
  };
}
