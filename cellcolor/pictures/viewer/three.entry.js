// What the viewer uses of three.js; CONTRIBUTING.md says how three.min.js is made of it.
export {
  BufferAttribute, BufferGeometry, Color, DataTexture, DirectionalLight, DoubleSide, Group,
  HemisphereLight, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, PerspectiveCamera, Scene, SphereGeometry, SRGBColorSpace, Vector3, Vector4,
  WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { LineMaterial } from "three/addons/lines/LineMaterial.js";
export { LineSegments2 } from "three/addons/lines/LineSegments2.js";
export { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
export { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
