// The picture: loads the recordings into Meshcat's viewer, extends the floor, places cameras and walkers.
const picture = (() => {
  const BESIDE = 1.3;

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

  const look = (position, target) => {
    viewer.camera.position.set(...up(position));
    viewer.controls.target.set(...up(target));
  };

  return {
    views, frameRate: frameRate > 0 && frameRate <= 1000 ? frameRate : 30, runs: runs.length,
    // Everything at a time [s]; a shorter recording stays at its end.
    show(time) {
      viewer.animator.seek(time);
      place();
      viewer.set_dirty();
    },
    look,
    view(name) {
      const {position, target} = views[name];
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
    onTurn(action) { viewer.controls.addEventListener("start", action); },
  };
})();
