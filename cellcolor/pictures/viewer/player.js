// Time: the slider, the play button and everything that follows them.
"use strict";

class Motion {
  // The frames of the trajectory; between two of them every joint moves in proportion to time.
  constructor(data) {
    this.data = data;
    const times = unpack(data.times);
    this.start = times[0];
    this.times = times.map((moment) => moment - this.start);
    this.end = this.times.at(-1);
    this.joints = unpack(data.joints);
    this.states = unpack(data.states); // from a frame to the next: 0 between strokes, 1 in contact, 2 not planned
    this.segment = unpack(data.segment);
    this.count = data.names.length;
  }

  // The last frame up to a moment, and the share of the way from there to the next.
  at(now) {
    let low = 0, high = this.times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= now) low = middle;
      else high = middle - 1;
    }
    const span = this.times[low + 1] - this.times[low];
    return [low, span > 0 ? Math.min(1, Math.max(0, (now - this.times[low]) / span)) : 0];
  }

  configuration(now) {
    const [frame, share] = this.at(now), next = Math.min(frame + 1, this.times.length - 1);
    return Array.from({ length: this.count }, (_, joint) => {
      const before = this.joints[this.count * frame + joint];
      return before + share * (this.joints[this.count * next + joint] - before);
    });
  }

  // A bar over each time in one state and segment, of the class that is asked for; "" for none.
  bars(named, filled = () => null) {
    const bars = [], { times, states, segment, end } = this;
    for (let first = 0, frame = 1; frame < times.length; frame++) {
      const last = frame === times.length - 1;
      if (!last && states[frame] === states[first] && segment[frame] === segment[first]) continue;
      const [x, width] = [times[first], times[frame] - times[first]].map((time) => (WIDE * time) / (end || 1));
      const bar = { class: named(states[first]), x, width: Math.max(1, width), height: HIGH };
      const fill = filled(states[first], segment[first]);
      if (bar.class) bars.push(element("rect", fill ? { ...bar, style: `fill: ${fill}` } : bar));
      first = frame;
    }
    return bars;
  }
}

class Player {
  constructor(data, view) {
    const find = (id) => document.getElementById(id);
    Object.assign(this, { view, find, now: 0, playing: false });
    this.motion = new Motion(data.motion);
    this.charts = new Charts(find("charts"), this.motion, (moment) => this.go(moment));
    this.controls(data);
    document.addEventListener("click", (event) => this.leads(event));
    document.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.leads(event);
      // Buttons, boxes and lists have a use for the space bar of their own.
      if (event.key !== " " || event.target.closest("button, select, input:not([type=range])")) return;
      event.preventDefault();
      this.play(!this.playing);
    });
    this.go(0);
  }

  controls(data) {
    const { find, motion } = this, slider = find("time");
    slider.max = motion.end;
    slider.addEventListener("input", () => this.go(Number(slider.value)));
    find("play").addEventListener("click", () => this.play(!this.playing));
    const usual = [1, 2, 5, 10, 20, 50].find((factor) => motion.end / factor <= 45) || 100;
    for (const factor of [1, 2, 5, 10, 20, 50, 100])
      find("speed").append(new Option(`${factor}×`, factor, factor === usual, factor === usual));
    const fills = data.modes[0].classes, phases = find("phases");
    phases.append(stretched(...motion.bars(
      (state) => ["move", "contact", "unplanned"][state],
      (state, segment) => (state === 1 ? fills[segment]?.rgb : null),
    )));
    for (const { time, text } of data.motion.faults) {
      const fault = document.createElement("button");
      Object.assign(fault, { type: "button", title: text, className: "fault" });
      fault.setAttribute("aria-label", `fault at ${time.toFixed(2)} s: ${text}`);
      fault.dataset.time = time;
      fault.style.left = `${(100 * (time - motion.start)) / (motion.end || 1)}%`;
      phases.append(fault);
    }
    phases.addEventListener("click", (event) => {
      const { left, width } = phases.getBoundingClientRect();
      if (!event.target.dataset.time) this.go((motion.end * (event.clientX - left)) / width);
    });
  }

  // Rows of tables, marks on the part and on the bar of time that have a time lead to it.
  leads(event) {
    const time = event.target.closest?.("[data-time]")?.dataset.time;
    if (time === undefined) return;
    this.play(false);
    this.go(Math.min(this.motion.end, Math.max(0, Number(time) - this.motion.start)));
    this.find("view").scrollIntoView({ block: "nearest" });
  }

  play(on) {
    // Play begins again at the end. A slider's value has fewer digits than the end itself.
    if (on && this.now > this.motion.end - 1e-3) this.go(0);
    if (on && !this.playing) requestAnimationFrame((clock) => this.tick(clock, clock));
    this.playing = on;
    this.find("play").textContent = on ? "❚❚" : "▶";
    this.find("play").setAttribute("aria-label", on ? "Pause" : "Play");
  }

  tick(clock, before) {
    if (!this.playing) return;
    const spent = Math.min(0.25, (clock - before) / 1000);
    const now = this.now + spent * Number(this.find("speed").value);
    if (now >= this.motion.end) this.play(false);
    this.go(Math.min(now, this.motion.end));
    requestAnimationFrame((later) => this.tick(later, clock));
  }

  // Everything at a moment, in seconds from the first frame.
  go(now) {
    this.now = now;
    const { find, motion } = this, [frame] = motion.at(now), state = motion.states[frame];
    const joints = motion.configuration(now);
    find("time").value = now;
    find("time").setAttribute("aria-valuetext", `${now.toFixed(1)} s`);
    find("clock").textContent = `${now.toFixed(2)} s of ${motion.end.toFixed(2)} s`;
    const tip = new THREE.Vector3().setFromMatrixPosition(armPoses(motion.data.arm, joints).at(-1));
    find("tip").textContent = `tip at ${tip.toArray().map((value) => value.toFixed(4)).join(", ")} m`;
    find("state").className = ["move", "contact", "unplanned"][state];
    find("state").textContent = [
      "between strokes",
      `in contact, segment ${motion.segment[frame]}`,
      "this move was not planned",
    ][state];
    this.charts.draw(now);
    this.view?.pose(joints, frame, state);
  }
}

// Rows and points of cards that show something on the part.
function links(data, view) {
  for (const link of document.querySelectorAll("[data-mode]")) {
    const number = data.modes.findIndex(({ name }) => name === link.dataset.mode);
    if (number < 0) continue;
    const show = () => {
      view.mode(number);
      document.getElementById("view").scrollIntoView({ block: "nearest" });
    };
    link.classList.add("link");
    link.addEventListener("click", show);
    link.addEventListener("keydown", (event) => event.key === "Enter" && show());
  }
}

function start(data) {
  let view = null;
  try {
    view = new View(data);
  } catch (fault) {
    const note = document.createElement("span");
    Object.assign(note, { className: "note", textContent: `No picture: ${fault.message}.` });
    document.getElementById("overlay").replaceChildren(note);
  }
  if (data.motion) new Player(data, view);
  view?.start();
  if (view) links(data, view);
}

start(JSON.parse(document.getElementById("data").textContent));
