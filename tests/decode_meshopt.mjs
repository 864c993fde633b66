// Decodes a GLB of EXT_meshopt_compression by the decoder that three.js brings: node decode_meshopt.mjs FILE PLAIN_FILE
import { readFileSync, writeFileSync } from "node:fs";

const decoder = new URL("../web/node_modules/three/examples/jsm/libs/meshopt_decoder.module.js", import.meta.url);
const { MeshoptDecoder } = await import(decoder);
await MeshoptDecoder.ready;
const [, , from, to] = process.argv;
const file = readFileSync(from);
const length = file.readUInt32LE(12);
const document = JSON.parse(file.subarray(20, 20 + length));
const binary = file.subarray(28 + length);
const parts = [];
let size = 0;
for (const view of document.bufferViews) {
  const packed = view.extensions?.EXT_meshopt_compression;
  let bytes = binary.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  if (packed) {
    bytes = new Uint8Array(packed.count * packed.byteStride);
    const source = binary.subarray(packed.byteOffset, packed.byteOffset + packed.byteLength);
    MeshoptDecoder.decodeGltfBuffer(bytes, packed.count, packed.byteStride, source, packed.mode, packed.filter);
    delete view.extensions;
  }
  Object.assign(view, { buffer: 0, byteOffset: size, byteLength: bytes.length });
  parts.push(bytes, new Uint8Array(-bytes.length & 3));
  size += bytes.length + (-bytes.length & 3);
}
document.buffers = [{ byteLength: size }];
for (const key of ["extensionsUsed", "extensionsRequired"]) {
  document[key] = document[key].filter((name) => name !== "EXT_meshopt_compression");
  if (!document[key].length) delete document[key];
}
let text = Buffer.from(JSON.stringify(document));
text = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
const number = (...values) => Buffer.from(new Uint32Array(values).buffer);
const head = [Buffer.from("glTF"), number(2, 28 + text.length + size, text.length), Buffer.from("JSON"), text, number(size), Buffer.from("BIN\0")];
writeFileSync(to, Buffer.concat([...head, ...parts]));
