// Meshcat's floor ends; this one goes along with the walker, and vanishes in the distance.
const endlessFloor = () => {
  const RADIUS = 45, CLEAR_RADIUS = 12, TILE = 5;

  const tile = () => {
    const canvas = document.createElement("canvas");
    const size = canvas.width = canvas.height = 1024, draw = canvas.getContext("2d");
    draw.fillStyle = "#dbdedb";
    draw.fillRect(0, 0, size, size);
    for (let line = 0; line <= TILE; line++) {
      const place = size * line / TILE, end = line % TILE === 0;
      draw.fillStyle = end ? "#8a9296" : "#b2b6b8";
      const width = size * (end ? 0.022 : 0.012) / TILE;
      draw.fillRect(place - width / 2, 0, width, size);
      draw.fillRect(0, place - width / 2, size, width);
    }
    const texture = new THREE.CanvasTexture(canvas);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.anisotropy = 8;
    return texture;
  };

  const geometry = new THREE.RingGeometry(0.001, RADIUS, 48, 12);
  const {position, uv} = geometry.attributes, colors = new Float32Array(4 * position.count).fill(1);
  for (let i = 0; i < position.count; i++) {
    const distance = Math.hypot(position.getX(i), position.getY(i));
    colors[4 * i + 3] = Math.max(0, Math.min(1, (RADIUS - distance) / (RADIUS - CLEAR_RADIUS)));
    uv.setXY(i, position.getX(i) / TILE, position.getY(i) / TILE);
  }
  geometry.setAttribute("color", new THREE.BufferAttribute(colors, 4));
  const map = tile();
  const floor = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({map, vertexColors: true, transparent: true}));
  floor.name = "endless floor";
  floor.receiveShadow = true;
  floor.renderOrder = -1;

  return {
    // Hides the floor of a plane that Meshcat draws, and its lines.
    hideDrawn(visualizer) {
      for (const child of visualizer.children)
        if (/^(floor$|along_|meter_)/.test(child.name)) child.visible = false;
    },
    // Replaces the floor of a plane, if there is one, within a group of the scene that moves.
    place(visualizer, scene, group) {
      const drawn = visualizer.children.find(child => child.name === "floor");
      if (!drawn) return;
      group.add(floor);
      floor.quaternion.setFromRotationMatrix(drawn.matrix);
      const normal = new THREE.Vector3(0, 0, 1).applyQuaternion(floor.quaternion);
      // The plane through the origin of W, seen from the point of the scene that stays.
      const origin = scene.position;
      floor.position.set(0, 0, origin.dot(normal) / normal.z);
      const {x, y} = floor.position.clone().sub(origin).applyQuaternion(floor.quaternion.clone().invert());
      map.offset.set((x / TILE) % 1, (y / TILE) % 1);
    },
  };
};
