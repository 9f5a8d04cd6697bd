// The picture: loads the recordings into Meshcat's viewer, extends the floor, places cameras and walkers.
const picture = (() => {
  const BESIDE = 1.3;
  // A height above all ground [m].
  const SKY = 1000;
  // Ground that rises by more than UNEVEN [m] lifts the camera by LIFT times the rest. With a factor of 1 the edges of
  // stairs hide the feet.
  const UNEVEN = 0.1, LIFT = 1.5;

  const recordings = [...document.querySelectorAll("script.recording")];
  const find = (...path) => viewer.scene_tree.find(path).object;

  // Meshcat evaluates the callbacks of other commands as JavaScript.
  const permitted = new Set(["set_object", "set_transform", "set_property", "set_animation", "set_target", "delete"]);
  const handle = viewer.handle_command;
  const animations = [];
  const ofRun = (run, path) => path.startsWith("/drake") ? `/run${run}${path}` : path;
  recordings.forEach((recording, run) => {
    viewer.handle_command = command => {
      if (!permitted.has(command.type)) return;
      if (command.type === "set_animation") {
        for (const animation of command.animations) animations.push({...animation, path: ofRun(run, animation.path)});
        return;
      }
      if (typeof command.path === "string") command.path = ofRun(run, command.path);
      handle.call(viewer, command);
    };
    for (const text of JSON.parse(recording.textContent))
      viewer.handle_command_bytearray(Uint8Array.from(atob(text), character => character.charCodeAt(0)));
  });
  viewer.handle_command = () => {};
  const frameRate = Number(animations[0]?.clip?.fps);
  if (animations.length > 0) {
    // Only what plays can be sought; our clock moves it.
    const options = {play: true, loopMode: THREE.LoopOnce, repetitions: 1, clampWhenFinished: true};
    handle.call(viewer, {type: "set_animation", animations, options});
    viewer.animator.pause();
  }
  // Its buttons would compete with ours.
  viewer.animator.folder?.hide?.();

  const runs = recordings.map((_, run) => ({group: find(`run${run}`), scene: find(`run${run}`, "drake")}));

  const floor = endlessFloor();
  const moveFloor = () => {
    runs.forEach((_, run) => floor.hideDrawn(find(`run${run}`, "drake", "visualizer")));
    floor.place(find("run0", "drake", "visualizer"), runs[0].scene, runs[0].group);
  };

  const {views} = JSON.parse(document.getElementById("constants").textContent);
  // The view in which the camera stays; none while it is free.
  let chosen = null;
  let arrangement = "beside", across = [0, 1];
  // z is up in W and in every group, y in three.js.
  const up = ([x, y, z]) => [x, z, -y];

  const place = () => {
    runs.forEach(({group, scene}, run) => {
      const side = arrangement === "beside" ? BESIDE * (run - (runs.length - 1) / 2) : 0;
      group.position.set(side * across[0], side * across[1], 0);
      if (arrangement === "ground" && run > 0)
        group.position.copy(runs[0].scene.position).sub(scene.position);
    });
    moveFloor();
  };

  // The second walker is transparent where it stands in the first one; arrows, which are drawn over all, stay.
  const fade = () => runs.slice(1).forEach(({group}) => group.traverse(({isMesh, material}) => {
    if (!isMesh || !material.depthTest) return;
    material.transparent = arrangement === "overlaid";
    material.opacity = material.transparent ? 0.45 : 1;
    material.needsUpdate = true;
  }));

  // Mean height of the first run's ground within 0.6 m of a place, along a direction [m]: about two steps of stairs.
  // A camera that followed every single step would jump.
  const ray = new THREE.Raycaster(), down = new THREE.Vector3(0, -1, 0);
  const groundAround = (x, y, direction) => {
    const ground = find("run0", "drake", "visualizer").children.filter(({name}) => name.startsWith("ground"));
    const heights = [-0.6, -0.3, 0, 0.3, 0.6].map(along => {
      const above = up([x + along * direction[0], y + along * direction[1], SKY]);
      ray.set(new THREE.Vector3(...above), down);
      return ray.intersectObjects(ground)[0]?.point.y ?? 0;
    });
    return heights.reduce((sum, height) => sum + height, 0) / heights.length;
  };

  // Ground that rises lifts the camera: ahead of a walker on stairs it would be inside them.
  const look = (position, target) => {
    const [x, y, z] = position, [dx, dy] = [x - target[0], y - target[1]], distance = Math.hypot(dx, dy);
    viewer.scene.updateMatrixWorld();
    const lift = LIFT * Math.max(groundAround(x, y, [dx / distance, dy / distance]) - UNEVEN, 0);
    viewer.camera.position.set(...up([x, y, z + lift]));
    viewer.controls.target.set(...up(target));
  };

  return {
    views, frameRate: frameRate > 0 && frameRate <= 1000 ? frameRate : 30, runs: runs.length,
    // Everything at a time [s]; a shorter recording stays at its end.
    show(time) {
      viewer.animator.seek(time);
      place();
      if (chosen) look(chosen.position, chosen.target);
      viewer.set_dirty();
    },
    look,
    // A free camera has no view, and stays where it is.
    view(name) {
      chosen = views[name];
      if (!chosen) return;
      const {position, target} = chosen;
      look(position, target);
      // Walkers side by side do not hide each other.
      const [x, y] = [position[0] - target[0], position[1] - target[1]], distance = Math.hypot(x, y);
      across = [-y / distance, x / distance];
      viewer.controls.update();
      place();
      viewer.set_dirty();
    },
    arrange(name) {
      arrangement = name;
      fade();
      place();
      viewer.set_dirty();
    },
    onTurn(action) {
      viewer.controls.addEventListener("start", () => {
        chosen = null;
        action();
      });
    },
  };
})();
