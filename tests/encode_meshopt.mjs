// Streams that meshoptimizer makes, with what its decoder makes of them, as JSON lines: node encode_meshopt.mjs
import { MeshoptEncoder } from "../web/node_modules/meshoptimizer/meshopt_encoder.js";
import { MeshoptDecoder } from "../web/node_modules/meshoptimizer/meshopt_decoder.mjs";

await MeshoptEncoder.ready;
await MeshoptDecoder.ready;

let state = 1;
const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
const several = (count, make) => Array.from({ length: count }, (_, k) => make(k));
const bytes = (array) => new Uint8Array(array.buffer);

function tell(source, count, stride, mode, filter) {
  const stream = MeshoptEncoder.encodeGltfBuffer(source, count, stride, mode, 0);
  const decoded = new Uint8Array(count * stride);
  MeshoptDecoder.decodeGltfBuffer(decoded, count, stride, stream, mode, filter);
  const text = (data) => Buffer.from(data).toString("base64");
  console.log(JSON.stringify({ count, stride, mode, filter, stream: text(stream), decoded: text(decoded) }));
}

for (const [count, stride] of [[1, 4], [16, 8], [300, 12], [700, 64], [40, 256]]) {
  const wide = several(stride, (k) => [1, 3, 20, 256][k % 4]); // bytes that are still, creep, jump, and are noise
  tell(Uint8Array.from(several(count * stride, (k) => random() * wide[k % stride])), count, stride, "ATTRIBUTES", "NONE");
}
const corner = (k) => Math.floor(k / 30) * 31 + (k % 30);
const net = several(600, corner).flatMap((c) => [c, c + 1, c + 31, c + 1, c + 32, c + 31]);
const noise = several(900, () => Math.floor(random() * 60000));
for (const [list, stride] of [[net, 2], [net, 4], [noise, 4], [[...net, 0, 1, 2, ...net], 2]]) {
  const source = stride === 2 ? Uint16Array.from(list) : Uint32Array.from(list);
  tell(bytes(source), list.length, stride, "TRIANGLES", "NONE");
  tell(bytes(source), list.length, stride, "INDICES", "NONE");
}
const unit = (size) => {
  const vector = several(size, () => 2 * random() - 1);
  const length = Math.hypot(...vector);
  return vector.map((x) => x / length);
};
const normals = Float32Array.from(several(200, () => [...unit(3), 1]).flat());
tell(MeshoptEncoder.encodeFilterOct(normals, 200, 4, 8), 200, 4, "ATTRIBUTES", "OCTAHEDRAL");
tell(MeshoptEncoder.encodeFilterOct(normals, 200, 8, 12), 200, 8, "ATTRIBUTES", "OCTAHEDRAL");
const turns = Float32Array.from(several(200, () => unit(4)).flat());
tell(MeshoptEncoder.encodeFilterQuat(turns, 200, 8, 14), 200, 8, "ATTRIBUTES", "QUATERNION");
const places = Float32Array.from(several(600, () => (2 * random() - 1) * 10 ** (6 * random() - 3)));
tell(MeshoptEncoder.encodeFilterExp(places, 200, 12, 15), 200, 12, "ATTRIBUTES", "EXPONENTIAL");
