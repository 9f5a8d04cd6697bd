// The clock and the controls.
(() => {
  const element = id => document.getElementById(id), player = element("player");
  const [play, back, forth, speed, loop, camera, arrangement, showPlots] =
    ["play", "back", "forth", "speed", "loop", "camera", "arrangement", "show-plots"].map(element);
  const slider = player.querySelector("input"), readout = player.querySelector("output"), icon = play.querySelector("path");
  const labels = [...document.querySelectorAll("meta[name=run]")].map(tag => tag.content);
  element("caption").textContent = labels.map((label, run) => labels.length < 2 ? label : `${run ? "- - " : "\u2014 "}${label}`).join("\n");

  const duration = viewer.animator.duration > 0 ? viewer.animator.duration : 0;
  let time = 0, playing = true, last;

  const draw = () => {
    picture.show(time);
    plots.draw(time);
    slider.value = time;
    const beyond = plots.end > 0 && time > plots.end + 0.02 ? `after the end of the run at ${plots.end.toFixed(2)} s, ` : "";
    readout.textContent = `${beyond}${time.toFixed(2)} of ${duration.toFixed(2)} s`;
  };
  const setPlaying = on => {
    playing = on;
    player.dataset.playing = on;
    icon.setAttribute("d", on ? "M2 1h4v12h-4zM8 1h4v12h-4z" : "M2 0l12 7l-12 7z");
  };
  const seek = to => {
    setPlaying(false);
    time = Math.max(0, Math.min(duration, to));
    draw();
  };
  const step = frames => seek((Math.round(time * picture.frameRate) + frames) / picture.frameRate);
  const toggle = () => {
    if (!playing && time >= duration) time = 0;
    setPlaying(!playing);
  };
  const press = button => button.getAttribute("aria-pressed") === "true";
  const flip = button => button.setAttribute("aria-pressed", !press(button));
  const choose = (select, by) => {
    const count = select.options.length;
    select.selectedIndex = by === 0 ? (select.selectedIndex + 1) % count : Math.max(0, Math.min(count - 1, select.selectedIndex + by));
    select.dispatchEvent(new Event("change"));
  };

  for (const name of [...Object.keys(picture.views), "free"]) camera.add(new Option(name === "free" ? name : `${name} view`, name));
  camera.addEventListener("change", () => picture.view(camera.value));
  picture.onTurn(() => { camera.value = "free"; });
  arrangement.hidden = picture.runs < 2;
  arrangement.addEventListener("change", () => picture.arrange(arrangement.value));
  const updatePlots = () => { plots.hidden = !(plots.any && press(showPlots)); draw(); };
  showPlots.hidden = !plots.any;
  if (innerWidth < 900) flip(showPlots);
  const actions = {
    Space: toggle, ArrowLeft: () => step(-1), ArrowRight: () => step(1),
    ArrowUp: () => choose(speed, 1), ArrowDown: () => choose(speed, -1), KeyC: () => choose(camera, 0),
    KeyL: () => flip(loop), KeyP: () => { flip(showPlots); updatePlots(); },
    KeyA: () => { if (!arrangement.hidden) choose(arrangement, 0); },
  };
  const buttons = [[play, toggle], [back, actions.ArrowLeft], [forth, actions.ArrowRight], [loop, actions.KeyL], [showPlots, actions.KeyP]];
  for (const [button, action] of buttons) button.addEventListener("click", () => { action(); button.blur(); });
  slider.addEventListener("input", () => seek(Number(slider.value)));
  for (const control of [slider, speed, camera, arrangement]) control.addEventListener("change", () => control.blur());
  window.addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("select") || !(event.code in actions)) return;
    event.preventDefault();
    actions[event.code]();
  });
  const scrub = event => { if (event.buttons & 1) seek(plots.timeAt(event)); };
  plots.canvas.addEventListener("pointerdown", scrub);
  plots.canvas.addEventListener("pointermove", scrub);
  window.addEventListener("resize", () => draw());

  player.hidden = !(duration > 0);
  slider.max = duration;
  setPlaying(duration > 0);
  picture.view(camera.value);
  updatePlots();
  requestAnimationFrame(function tick(now) {
    requestAnimationFrame(tick);
    if (playing) {
      time += Number(speed.value) * Math.min(1, (now - (last ?? now)) / 1000);
      if (time > duration) {
        if (press(loop)) time %= duration; else { time = duration; setPlaying(false); }
      }
      draw();
    }
    last = now;
  });
})();
