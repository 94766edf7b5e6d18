// Requests the newest view, shows it, and requests the next one: a slow connection shows fewer views, not older ones.
(() => {
  "use strict";

  const MAX_LISTED = 100;
  const TIMEOUT_MS = 6000; // the server answers within a second
  const RETRY_MS = 1000; // pause after a failure
  const NAMES = { starting: "Starting", live: "Live", stale: "Stale", reconnecting: "Reconnecting", ended: "Ended" };
  const token = new URLSearchParams(location.search).get("token");
  const element = (id) => document.getElementById(id);

  let shown = null; // state of the shown images
  let shownAt = 0; // when it arrived, by performance.now()
  let session = null;
  let unreachable = ""; // why the server does not answer
  let listed = new Map();

  function address(path, values) {
    const query = new URLSearchParams(values);
    if (token !== null) query.set("token", token);
    return `${path}?${query}`;
  }

  const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

  async function get(path, values) {
    const answer = await fetch(address(path, values), { signal: AbortSignal.timeout(TIMEOUT_MS) });
    if (!answer.ok) throw new Error(`the server returned error ${answer.status}`);
    return answer;
  }

  function number(value, decimals) {
    return value === null ? "–" : value.toFixed(decimals).replace("-", "−");
  }

  /** Rounds a value and its error to about two significant digits of the error. */
  function rounded(value, error) {
    const decimals = error === null || error >= 10 || Math.abs(value) >= 1000 ? 0 : error >= 1 || value >= 100 ? 1 : 2;
    return [number(value, decimals), error === null ? null : number(error, decimals)];
  }

  async function draw(id, frame) {
    const answer = await get(`/${id}.jpg`, { frame });
    const picture = await createImageBitmap(await answer.blob());
    return { canvas: element(id), picture, halfRange: Number(answer.headers.get("Colour-Range")) };
  }

  function put({ canvas, picture }) {
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      canvas.width = picture.width;
      canvas.height = picture.height;
    }
    canvas.getContext("2d").drawImage(picture, 0, 0);
    picture.close();
  }

  function showColourRange(halfRange) {
    element("scale_low").textContent = `−${halfRange} px, below road`;
    element("scale_high").textContent = `above road, +${halfRange} px`;
  }

  /** Draws a line through the image centre at the roll angle, between level marks. */
  function showHorizon(view) {
    const seen = view !== null && view.roll !== null && view.roll.observable;
    element("horizon").toggleAttribute("hidden", !seen);
    element("horizon_note").textContent = seen ? "the line shows the roll" : "the roll is not observable";
    if (!seen) return;
    const { width, height } = view;
    const [x, y] = [width / 2, height / 2];
    element("horizon").setAttribute("viewBox", `0 0 ${width} ${height}`);
    const line = `M${0.06 * width} ${y}H${0.42 * width}M${0.58 * width} ${y}H${0.94 * width}`;
    const level = `M0 ${y}H${0.045 * width}M${0.955 * width} ${y}H${width}`;
    for (const path of document.querySelectorAll("#horizon .line path")) path.setAttribute("d", line);
    for (const path of document.querySelectorAll("#horizon .level path")) path.setAttribute("d", level);
    document.querySelector("#horizon .line").setAttribute("transform", `rotate(${view.roll.degrees} ${x} ${y})`);
  }

  function showRoll(roll) {
    const known = roll !== null && roll.observable;
    element("roll").textContent = known ? `${number(roll.degrees, 2)}°` : roll === null ? "–" : "not observable";
    const why = roll === null ? "no road found" : "disparity nearly constant";
    element("roll_more").textContent = known ? `± ${number(roll.error_degrees, 2)}°` : why;
  }

  function showHeight(view) {
    element("height").textContent = view.height_m === null ? "–" : `${number(view.height_m, 2)} m`;
    const pitch = view.pitch_degrees;
    const looking = `pitch ${number(Math.abs(pitch), 1)}° ${pitch < 0 ? "up" : "down"}`;
    element("height_more").textContent = pitch === null ? "needs a calibration" : looking;
  }

  /** Largest of 1, 2, 5, 10, … metres that is at most `m`. */
  function roundLength(m) {
    const unit = 10 ** Math.floor(Math.log10(m));
    return [5, 2, 1].map((factor) => factor * unit).find((length) => length <= m);
  }

  /** Draws the path from above with the camera and a scale bar. */
  function showPath(path) {
    element("way").hidden = path === null;
    if (path === null) return;
    const [width, height, margin, least_m] = [640, 260, 24, 2];
    const points = path.points_m;
    const range = (axis) => {
      const values = points.map((point) => point[axis]);
      return [Math.min(...values), Math.max(...values)];
    };
    const [[west, east], [south, north]] = [range(0), range(1)];
    const span = (low, high) => Math.max(high - low, least_m);
    const scale = Math.min((width - 2 * margin) / span(west, east), (height - 3 * margin) / span(south, north));
    const x = (m) => width / 2 + scale * (m - (west + east) / 2);
    const y = (m) => height / 2 - margin / 2 - scale * (m - (south + north) / 2);
    const draw = (selector, d) => document.querySelector(`#way_map ${selector}`).setAttribute("d", d);
    draw(".path", `M${points.map(([east_m, north_m]) => `${x(east_m).toFixed(1)} ${y(north_m).toFixed(1)}`).join("L")}`);
    draw(".camera", "M0 -9L6 7L0 4L-6 7Z");
    const [at_x, at_y] = points[points.length - 1];
    document.querySelector("#way_map .camera").setAttribute("transform",
      `translate(${x(at_x).toFixed(1)} ${y(at_y).toFixed(1)}) rotate(${path.heading_degrees})`);
    const bar_m = roundLength(0.3 * width / scale);
    const text = document.querySelector("#way_map .bar text");
    draw(".bar path", `M${margin} ${height - 16}v8h${(bar_m * scale).toFixed(1)}v-8`);
    text.textContent = `${bar_m} m`;
    text.setAttribute("x", margin + bar_m * scale + 8);
    text.setAttribute("y", height - 8);
    element("way_length").textContent = `${number(path.length_m, 1)} m`;
    const breaks = path.pieces - 1;
    element("way_pieces").textContent = breaks === 0 ? ""
      : `Restarted ${breaks === 1 ? "once" : `${breaks} times`}: a frame could not be linked to those before it.`;
  }

  function showCounts(state) {
    const { counts, latency_ms: latency, recording } = state;
    const dropped = counts.dropped + counts.too_old;
    element("fps").textContent = number(state.fps, 1);
    element("fps_more").textContent = `${dropped} dropped` + (counts.rejected > 0 ? `, ${counts.rejected} rejected` : "");
    element("latency").textContent = `${number(latency.median, 0)} ms`;
    element("latency_more").textContent = `95 %: ${number(latency.p95, 0)} ms`;
    element("recording").hidden = recording === null;
    if (recording === null) return;
    element("recorded").textContent = `${recording.recorded} pairs`;
    element("recorded_more").textContent = recording.message ? "stopped" : `${recording.skipped} skipped`;
  }

  function cell(row, ...content) {
    const made = document.createElement("td");
    made.append(...content);
    row.append(made);
  }

  function small(text) {
    const made = document.createElement("small");
    made.textContent = text;
    return made;
  }

  function withError(figure, sign) {
    const [value, error] = rounded(figure.value, figure.error);
    return [sign + value, small(error === null ? ` ${figure.unit}` : ` ± ${error} ${figure.unit}`)];
  }

  function row(damage) {
    const made = document.createElement("tr");
    cell(made, new Date(1000 * damage.time_s).toLocaleTimeString([], { hour12: false }));
    cell(made, damage.kind, ...(damage.cut ? [small(" cut by the border")] : []));
    cell(made, ...withError(damage.depth, damage.kind === "protrusion" ? "+" : ""));
    cell(made, ...withError(damage.area, ""));
    if (damage.severity === null) {
      cell(made, "–");
      return made;
    }
    const chip = document.createElement("span");
    chip.className = `chip ${damage.severity}`;
    chip.textContent = damage.severity.replace("unresolvable", "un\u00adresolv\u00adable");  // may break on a phone
    cell(made, chip);
    return made;
  }

  function showList(state) {
    element("found").textContent = `${state.damages_found} found`;
    if (state.damages.length === 0) return;
    for (const damage of state.damages) listed.set(damage.id, row(damage));
    const newest = [...listed.keys()].sort((a, b) => b - a).slice(0, MAX_LISTED);
    listed = new Map(newest.map((id) => [id, listed.get(id)]));
    document.querySelector("#list tbody").replaceChildren(...listed.values());
    document.querySelector("#list .scroll").hidden = false;
    element("none").hidden = true;
  }

  /** Returns the error message to show, or "". */
  function errorText() {
    if (unreachable) return unreachable;
    if (shown === null) return "";
    const parts = [shown.message, shown.recording?.message, ...(shown.view?.warnings ?? [])];
    return parts.filter(Boolean).join(". ");
  }

  /** Updates the age; called periodically. */
  function showAge() {
    const age = shown === null ? 0 : shown.age_s + (performance.now() - shownAt) / 1000;
    const pictured = shown !== null && shown.view !== null;
    const old = pictured && age > shown.max_age_s;
    let state = shown === null ? "starting" : shown.state;
    if (old && state === "live") state = "stale";
    document.body.dataset.state = state;
    document.body.classList.toggle("old", old);
    if (element("state").textContent !== NAMES[state]) element("state").textContent = NAMES[state];
    element("age").textContent = !pictured ? "–" : age < 1 ? `${number(1000 * age, 0)} ms` : `${number(age, 1)} s`;
    element("age_more").textContent = shown === null ? "" : `limit ${number(1000 * shown.max_age_s, 0)} ms`;
    for (const overdue of document.querySelectorAll(".overdue")) {
      overdue.hidden = !old;
      overdue.textContent = `no new image for ${number(age, age < 10 ? 1 : 0)} s`;
    }
    const text = errorText();
    element("message").hidden = text === "";
    if (element("message").textContent !== text) element("message").textContent = text;
  }

  function show(state, arrived) {
    shown = state;
    shownAt = arrived;
    document.body.dataset.frame = state.frame;
    showCounts(state);
    showHorizon(state.view);
    showPath(state.path);
    if (state.view !== null) {
      showRoll(state.view.roll);
      showHeight(state.view);
    }
    showAge();
  }

  function resetSession(state) {
    session = state.session;
    listed.clear();
    document.querySelector("#list tbody").replaceChildren();
    document.querySelector("#list .scroll").hidden = true;
    element("none").hidden = false;
  }

  /** Requests one view; returns its number. */
  async function refresh(after) {
    const state = await (await get("/state", { after })).json();
    const arrived = performance.now();
    unreachable = "";
    if (session !== state.session) {
      const first = session === null;
      resetSession(state);
      if (!first) return 0; // another run: start again
    }
    showList(state);
    if (state.frame > after && !document.hidden) {
      const [left, transformed] = await Promise.all([draw("left", state.frame), draw("transformed", state.frame)]);
      put(left);
      put(transformed);
      showColourRange(transformed.halfRange);
    }
    show(state, arrived);
    if (state.state === "ended" || document.hidden) await pause(RETRY_MS);
    return state.frame;
  }

  async function run() {
    let after = 0;
    while (true) {
      try {
        after = await refresh(after);
      } catch (error) {
        const ended = shown !== null && shown.state === "ended";
        unreachable = ended ? "The run has ended." : `No connection to roadstereo (${error.message}); retrying.`;
        await pause(RETRY_MS);
      }
    }
  }

  setInterval(showAge, 100);
  run();
})();
