// Data of the page: the report, the garment and the body.

/** The text of an element that holds data. */
const held = (id) => document.getElementById(id).textContent;

/** Bytes of a base64 text. */
function bytesOf(text) {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Reads the meshes of a binary glTF file as this program writes it. */
function readGlb(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  const begin = 20 + length + 8;
  const widths = { SCALAR: 1, VEC2: 2, VEC3: 3 };
  const array = (index) => {
    const accessor = json.accessors[index];
    const at = begin + (json.bufferViews[accessor.bufferView].byteOffset || 0);
    const count = accessor.count * widths[accessor.type];
    const kinds = { 5126: Float32Array, 5125: Uint32Array, 5123: Uint16Array };
    const Kind = kinds[accessor.componentType];
    return new Kind(bytes.slice(at, at + count * Kind.BYTES_PER_ELEMENT).buffer);
  };
  return json.meshes.map((mesh) => {
    const primitive = mesh.primitives[0];
    const material = (json.materials || [])[primitive.material];
    const attributes = {};
    for (const [name, index] of Object.entries(primitive.attributes)) attributes[name] = array(index);
    const color = material ? material.pbrMetallicRoughness.baseColorFactor : [0.8, 0.7, 0.62, 1];
    return { name: mesh.name, attributes, indices: array(primitive.indices), color, extras: mesh.extras || {} };
  });
}

/**
 * All meshes as one. Every vertex knows its piece.
 * @returns positions, normals, flat positions (mm), triangles, piece of every vertex, values by the name of their map.
 */
function joined(meshes) {
  const count = meshes.reduce((sum, mesh) => sum + mesh.attributes.POSITION.length / 3, 0);
  const corners = meshes.reduce((sum, mesh) => sum + mesh.indices.length, 0);
  const out = {
    count,
    positions: new Float32Array(3 * count),
    normals: new Float32Array(3 * count),
    flat: new Float32Array(2 * count),
    triangles: new Uint32Array(corners),
    pieceOf: new Uint16Array(count),
    first: [],
    values: {},
    pieces: meshes,
  };
  const names = new Set(meshes.flatMap((mesh) => Object.keys(mesh.attributes).filter((name) => name[0] === "_")));
  for (const name of names) out.values[name] = new Float32Array(count);
  let [vertex, corner] = [0, 0];
  meshes.forEach((mesh, piece) => {
    const own = mesh.attributes.POSITION.length / 3;
    out.positions.set(mesh.attributes.POSITION, 3 * vertex);
    if (mesh.attributes.NORMAL) out.normals.set(mesh.attributes.NORMAL, 3 * vertex);
    if (mesh.attributes.TEXCOORD_0) out.flat.set(mesh.attributes.TEXCOORD_0, 2 * vertex);
    for (const name of names) if (mesh.attributes[name]) out.values[name].set(mesh.attributes[name], vertex);
    out.pieceOf.fill(piece, vertex, vertex + own);
    for (let k = 0; k < mesh.indices.length; k++) out.triangles[corner + k] = mesh.indices[k] + vertex;
    out.first.push(vertex);
    vertex += own;
    corner += mesh.indices.length;
  });
  return out;
}
