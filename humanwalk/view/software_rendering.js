// Rendering on the processor pays for every triangle, highlight and soft shadow.
const cheapScene = (() => {
  const round = [8, 12, 16].map(n => new THREE.SphereGeometry(1, n, Math.round(0.75 * n)));
  const done = new WeakSet();

  const simplifyMesh = (mesh, pixelsPerMeter) => {
    const {color, map, transparent, opacity, side, depthTest, vertexColors} = mesh.material;
    if (!mesh.material.isMeshLambertMaterial)
      mesh.material =
        new THREE.MeshLambertMaterial({color, map, transparent, opacity, side, depthTest, vertexColors});
    if (!mesh.castShadow) return;
    mesh.geometry.computeBoundingSphere();
    const size = mesh.geometry.boundingSphere.radius * mesh.matrixWorld.getMaxScaleOnAxis() * pixelsPerMeter;
    mesh.castShadow = size > 12;
    const coarse = size < 5 ? 0 : size < 12 ? 1 : size < 50 ? 2 : 3;
    const {type, parameters: {radius: r, height: h} = {}} = mesh.geometry;
    if (type === "SphereGeometry" && coarse < 3) mesh.geometry = round[coarse];
    if (type === "CapsuleGeometry" && coarse < 3)
      mesh.geometry = new THREE.CapsuleGeometry(r, h, 2 + coarse, 8 + 2 * coarse);
  };

  const simplifyShadow = ({shadow}) => {
    shadow.map?.dispose();
    shadow.map = null;
    shadow.mapSize.set(1024, 1024);
    Object.assign(shadow.camera, {left: -1.6, right: 1.6, bottom: -1.6, top: 1.6}).updateProjectionMatrix();
  };

  return {
    // Diffuse materials, hard shadows near the walker only, fewer triangles for what is small; each object once.
    simplify(viewer, height) {
      viewer.renderer.shadowMap.type = 0;
      viewer.scene.updateMatrixWorld(true);
      viewer.scene.traverse(object => {
        if (done.has(object) || !(object.isMesh || object.isDirectionalLight)) return;
        done.add(object);
        if (object.isMesh) simplifyMesh(object, height / 2.4);
        else simplifyShadow(object);
      });
    },
    isNeeded(viewer) {
      const gl = viewer.renderer.getContext(), names = gl.getExtension("WEBGL_debug_renderer_info");
      const renderer = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
      return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);
    },
    // A simulation needs the processor more than its picture does: that gets a third of the time.
    drawSeldom(viewer) {
      const gl = viewer.renderer.getContext(), pixel = new Uint8Array(4), render = viewer.render.bind(viewer);
      let due = 0;
      viewer.render = () => {
        const begin = performance.now();
        if (begin < due) return;
        this.simplify(viewer, innerHeight);
        render();
        // Waits until it is drawn.
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        due = begin + 3 * (performance.now() - begin);
      };
    },
  };
})();
