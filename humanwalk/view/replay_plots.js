// Plots of the runs around the present time, in one canvas.
const plots = (() => {
  const WINDOW = 3, TRACE = 0.5, COLORS = {Right: "#1a6bb3", Left: "#de661a"}, INK = "#233", PALE = "#c8ced2";
  const {channels, outline} = JSON.parse(document.getElementById("constants").textContent);
  const index = name => channels.indexOf(name), width = channels.length;

  const runs = [...document.querySelectorAll("script.samples")].map(tag => {
    const bytes = Uint8Array.from(atob(JSON.parse(tag.textContent)), character => character.charCodeAt(0));
    const values = new Float32Array(bytes.buffer), rows = values.length / width;
    return {rows, end: rows ? values[(rows - 1) * width] : 0, at: (row, channel) => values[row * width + channel]};
  });
  // First row at or after a time.
  const rowAt = ({rows, at}, time) => {
    let low = 0, high = rows;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (at(middle, 0) < time) low = middle + 1; else high = middle;
    }
    return low;
  };

  const panel = document.getElementById("plots"), canvas = panel.querySelector("canvas"), draw = canvas.getContext("2d");
  const sides = names => ["Right", "Left"].flatMap(side => names.map((name, i) => ({side, channel: index(`${side} ${name}`), thin: i > 0})));
  const panels = [
    {title: "ground reaction [N]: vertical, thin fore-aft", curves: sides(["vertical", "fore-aft"]), share: 1.5},
    {title: "hip flexion [deg]", curves: sides(["hip"]), share: 1},
    {title: "knee flexion [deg]", curves: sides(["knee"]), share: 1},
    {title: "ankle dorsiflexion [deg]", curves: sides(["ankle"]), share: 1},
  ].map(plot => ({...plot, range: rangeOf(plot.curves)})).filter(({range}) => range);
  const hasForces = runs.some(run => {
    for (let row = 0; row < run.rows; row++) if (run.at(row, index("Right cop x")) >= -9 || run.at(row, index("Left cop x")) >= -9) return true;
    return false;
  });

  function rangeOf(curves) {
    let low = Infinity, high = -Infinity;
    for (const run of runs)
      for (const {channel} of curves)
        for (let row = 0; row < run.rows; row++) {
          const value = run.at(row, channel);
          if (value < low) low = value;
          if (value > high) high = value;
        }
    if (!(high > low)) return null;
    const step = [1, 2, 5].flatMap(n => [n, 10 * n, 100 * n, 1000 * n]).sort((a, b) => a - b).find(n => (high - low) / n <= 4) ?? (high - low) / 4;
    return {low, high, step};
  }

  const text = (words, x, y, align = "left", color = INK) => {
    draw.fillStyle = color;
    draw.textAlign = align;
    draw.fillText(words, x, y);
  };

  let begin = 0, left = 42, right = 0;
  const xOf = time => left + (right - left) * (time - begin) / WINDOW;

  function drawCurves({title, curves, range: {low, high, step}}, top, bottom, time) {
    const yOf = value => bottom - (bottom - top) * (value - low) / (high - low);
    text(title, left, top - 5);
    draw.lineWidth = 1;
    for (let level = Math.ceil(low / step) * step; level <= high; level += step) {
      draw.strokeStyle = PALE;
      draw.beginPath(); draw.moveTo(left, yOf(level)); draw.lineTo(right, yOf(level)); draw.stroke();
      text(String(level), left - 5, yOf(level) + 4, "right");
    }
    runs.forEach((run, number) => {
      const first = Math.max(0, rowAt(run, begin) - 1), last = Math.min(run.rows, rowAt(run, begin + WINDOW) + 1);
      for (const {side, channel, thin} of curves) {
        draw.strokeStyle = COLORS[side];
        draw.lineWidth = thin ? 0.8 : 1.6;
        draw.setLineDash(number > 0 ? [4, 3] : []);
        draw.beginPath();
        let pen = false;
        for (let row = first; row < last; row++) {
          const value = run.at(row, channel);
          if (!Number.isFinite(value)) { pen = false; continue; }
          const [x, y] = [xOf(run.at(row, 0)), yOf(value)];
          if (pen) draw.lineTo(x, y); else draw.moveTo(x, y);
          pen = true;
        }
        draw.stroke();
      }
    });
    draw.setLineDash([]);
    draw.strokeStyle = INK;
    draw.lineWidth = 1;
    draw.beginPath(); draw.moveTo(xOf(time), top); draw.lineTo(xOf(time), bottom); draw.stroke();
  }

  // Both soles from above, toes to the right, the left foot above; the center of pressure and its last half second.
  function drawSoles(top, bottom, time) {
    text("center of pressure under the soles", left, top - 5);
    const widest = Math.max(...outline.map(part => part[2])), height = (bottom - top) / 2;
    const length = Math.min(right - left - 40, 0.9 * height / widest), start = left + 30;
    ["Left", "Right"].forEach((side, place) => {
      const middle = top + height * (place + 0.5);
      draw.fillStyle = `${COLORS[side]}33`;
      for (const [back, front, wide] of outline)
        draw.fillRect(start + length * back, middle - length * wide / 2, length * (front - back), length * wide);
      text(side[0], start - 20, middle + 4, "left", COLORS[side]);
      runs.forEach((run, number) => {
        const [x, y] = [index(`${side} cop x`), index(`${side} cop y`)];
        const now = Math.min(run.rows, rowAt(run, time + 1e-3)) - 1;
        if (time > run.end + 0.05) return;
        for (let row = Math.max(0, rowAt(run, time - TRACE)); row <= now; row++) {
          if (!Number.isFinite(run.at(row, x))) continue;
          draw.beginPath();
          draw.arc(start + length * run.at(row, x), middle - length * run.at(row, y), row === now ? 5 : 1.5, 0, 7);
          draw.fillStyle = draw.strokeStyle = COLORS[side];
          if (number > 0) draw.stroke(); else draw.fill();
        }
      });
    });
  }

  return {
    any: panels.length > 0,
    end: Math.max(0, ...runs.map(run => run.end)),
    set hidden(hidden) { panel.hidden = hidden; },
    timeAt(event) { return begin + WINDOW * (event.offsetX - left) / (right - left); },
    canvas,
    draw(time) {
      if (panel.hidden || !panels.length) return;
      const ratio = devicePixelRatio || 1, {clientWidth, clientHeight} = canvas;
      if (canvas.width !== Math.round(clientWidth * ratio) || canvas.height !== Math.round(clientHeight * ratio))
        Object.assign(canvas, {width: Math.round(clientWidth * ratio), height: Math.round(clientHeight * ratio)});
      draw.setTransform(ratio, 0, 0, ratio, 0, 0);
      draw.clearRect(0, 0, clientWidth, clientHeight);
      draw.font = "11px system-ui, sans-serif";
      right = clientWidth - 8;
      begin = Math.floor(time / WINDOW + 1e-9) * WINDOW;
      const gap = 20, shares = panels.reduce((sum, plot) => sum + plot.share, hasForces ? 1.4 : 0);
      const unit = (clientHeight - 18 - gap * (panels.length + (hasForces ? 1 : 0))) / shares;
      let top = gap;
      for (const plot of panels) {
        drawCurves(plot, top, top + unit * plot.share, time);
        top += unit * plot.share + gap;
      }
      const axis = top - gap + 13;
      for (let second = 0; second <= WINDOW; second++) text(`${begin + second}${second === WINDOW ? " s" : ""}`, xOf(begin + second), axis, second === WINDOW ? "right" : "center");
      if (hasForces) drawSoles(top + 16, clientHeight - 2, time);
    },
  };
})();
