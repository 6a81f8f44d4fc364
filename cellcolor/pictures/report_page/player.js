// Time: the slider, the play button and everything that follows them.
"use strict";

const INK_ON_PHASES = "#000"; // faults

class Motion {
  // The frames of the trajectory; between two of them every joint moves in proportion to time.
  constructor(data) {
    const { frames } = data;
    this.times = unpack(frames.times);
    this.joints = Array.from(unpack(frames.joints));
    this.contact = unpack(frames.contact);
    this.segment = unpack(frames.segment);
    this.unplanned = unpack(frames.unplanned);
    this.count = data.joint_names.length;
    const start = this.times[0];
    this.times = this.times.map((moment) => moment - start);
    this.start = start;
    this.end = this.times.at(-1);
    this.phases = [];
    for (let frame = 0; frame + 1 < this.times.length; frame++) {
      const [state, segment] = [this.state(frame), this.segment[frame]], last = this.phases.at(-1);
      if (last && last[2] === state && last[3] === segment) last[1] = this.times[frame + 1];
      else this.phases.push([this.times[frame], this.times[frame + 1], state, segment]);
    }
  }

  // From this frame to the next: 0 between strokes, 1 in contact, 2 not planned.
  state(frame) {
    if (this.unplanned[frame]) return 2;
    const next = Math.min(frame + 1, this.times.length - 1);
    return this.contact[frame] && this.contact[next] ? 1 : 0;
  }

  // The last frame up to a moment, and the share of the way from there to the next.
  at(now) {
    let low = 0, high = this.times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= now) low = middle;
      else high = middle - 1;
    }
    if (low === this.times.length - 1) return [low, 0];
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
}

class Player {
  constructor(data) {
    const find = (id) => document.getElementById(id);
    Object.assign(this, { data, find, now: 0, playing: false, shownAt: null });
    this.motion = new Motion(data);
    try {
      this.space = new Space(find("space"), find("overlay"), data);
    } catch (fault) {
      const note = document.createElement("span");
      note.className = "note";
      note.textContent = `No picture: ${fault.message}.`;
      find("overlay").replaceChildren(note);
    }
    this.charts = new Charts(find("charts"), data, this.motion, (moment) => this.go(moment));
    this.controls();
    this.shortcuts();
    new ResizeObserver(() => this.drawPhases()).observe(find("phases"));
    find("phases").addEventListener("click", (event) => this.nearestFault(event));
    this.drawPhases();
    this.go(0);
    requestAnimationFrame((clock) => this.tick(clock));
  }

  controls() {
    const { find, motion, space } = this, slider = find("time");
    slider.max = motion.end;
    slider.addEventListener("input", () => this.go(Number(slider.value)));
    find("play").addEventListener("click", () => this.play(!this.playing));
    const usual = [1, 2, 5, 10, 20, 50].find((factor) => motion.end / factor <= 45) || 100;
    for (const factor of [1, 2, 5, 10, 20, 50, 100]) {
      const option = new Option(`${factor}×`, factor, factor === usual, factor === usual);
      find("speed").append(option);
    }
    find("any-unplanned").hidden = !motion.unplanned.some(Boolean);
    find("fit").addEventListener("change", (event) => {
      this.charts.fit = event.target.checked;
      this.charts.resized();
    });
    if (!space) return;
    for (const name of ["arm", "path", "moves", "around"])
      find(`show-${name}`).addEventListener("change", (event) => {
        space.shown[name] = event.target.checked;
        space.dirty = true;
      });
    for (const name of ["whole", "part"]) find(name).addEventListener("click", () => space.look(name));
    this.data.modes.forEach((mode, number) => {
      if (mode.button === false) return; // these come last, for rows and points of cards
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = mode.name;
      button.addEventListener("click", () => this.mode(number));
      find("modes").append(button);
    });
    for (const link of document.querySelectorAll("[data-mode]")) {
      const number = this.data.modes.findIndex((mode) => mode.name === link.dataset.mode);
      if (number < 0) continue;
      const show = () => {
        this.mode(number);
        find("view").scrollIntoView({ block: "nearest" });
      };
      link.classList.add("link");
      link.addEventListener("click", show);
      link.addEventListener("keydown", (event) => event.key === "Enter" && show());
    }
    this.mode(0);
  }

  // Rows of tables and marks on the part that have a time lead to it; the space bar plays.
  shortcuts() {
    const time = (event) => event.target.closest?.("[data-time]")?.dataset.time;
    const show = (event) => {
      if (time(event) === undefined) return;
      this.play(false);
      this.go(Math.min(this.motion.end, Math.max(0, Number(time(event)) - this.motion.start)));
      this.find("view").scrollIntoView({ block: "nearest" });
    };
    document.addEventListener("click", show);
    document.addEventListener("keydown", (event) => {
      if (event.key === "Enter") show(event);
      // Buttons, boxes and lists have a use for the space bar of their own.
      if (event.key !== " " || event.target.closest("button, select, input:not([type=range])")) return;
      event.preventDefault();
      this.play(!this.playing);
    });
  }

  mode(number) {
    this.space.mode(number);
    [...this.find("modes").children].forEach((button, k) =>
      button.setAttribute("aria-pressed", String(k === number)));
    const entry = (color, text) => {
      const row = document.createElement("div"), mark = document.createElement("i");
      mark.style.background = color;
      row.append(mark, document.createTextNode(text));
      return row;
    };
    const classes = this.data.modes[number].classes.filter((own) => own.used);
    this.find("legend").replaceChildren(...classes.map((own) => entry(own.rgb, own.name.replaceAll(" %", "\u00a0%"))));
  }

  play(on) {
    // Play begins again at the end. A slider's value has fewer digits than the end itself.
    if (on && this.now > this.motion.end - 1e-3) this.go(0);
    this.playing = on;
    this.last = null;
    this.find("play").textContent = on ? "❚❚" : "▶";
    this.find("play").setAttribute("aria-label", on ? "Pause" : "Play");
  }

  tick(clock) {
    if (this.playing) {
      if (this.last !== null) {
        const spent = Math.min(0.25, (clock - this.last) / 1000);
        const now = this.now + spent * Number(this.find("speed").value);
        if (now >= this.motion.end) this.play(false);
        this.go(Math.min(now, this.motion.end));
      }
      this.last = clock;
    }
    if (this.space && (this.space.dirty || this.shownAt !== this.now)) {
      const [frame] = this.motion.at(this.now);
      const joints = this.motion.configuration(this.now);
      this.space.draw(joints, this.now + this.motion.start, this.motion.state(frame));
      this.shownAt = this.now;
    }
    requestAnimationFrame((later) => this.tick(later));
  }

  // Everything at a moment, in seconds from the first frame.
  go(now) {
    this.now = now;
    const { find, motion } = this, [frame] = motion.at(now), state = motion.state(frame);
    find("time").value = now;
    find("clock").textContent = `${now.toFixed(2)} s of ${motion.end.toFixed(2)} s`;
    const tip = armPoses(this.data.arm, motion.configuration(now)).at(-1);
    const place = [tip[3], tip[7], tip[11]].map((value) => value.toFixed(4)).join(", ");
    find("tip").textContent = `tip at ${place} m`;
    find("state").className = ["move", "contact", "unplanned"][state];
    find("state").textContent = [
      "between strokes",
      `in contact, segment ${motion.segment[frame]}`,
      "this move was not planned",
    ][state];
    this.charts.draw(now);
  }

  // On the bar of phases a click leads to that moment, or to a fault beside it.
  nearestFault(event) {
    const { left, width } = this.find("phases").getBoundingClientRect(), { motion } = this;
    const moment = (motion.end * (event.clientX - left)) / width;
    const near = this.data.faults.map((fault) => fault - motion.start)
      .filter((fault) => Math.abs(fault - moment) < (6 * motion.end) / width)
      .sort((a, b) => Math.abs(a - moment) - Math.abs(b - moment));
    this.go(near[0] ?? moment);
  }

  drawPhases() {
    const canvas = this.find("phases"), { motion } = this;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    Object.assign(canvas, { width: canvas.clientWidth * ratio, height: canvas.clientHeight * ratio });
    const pen = canvas.getContext("2d"), fills = this.data.modes[0].classes;
    for (const [from, to, state, segment] of motion.phases) {
      pen.fillStyle = state === 1 ? fills[segment]?.rgb || CONTACT : state === 2 ? BAD : MOVE;
      const [left, right] = [from, to].map((moment) => (canvas.width * moment) / (motion.end || 1));
      pen.fillRect(left, 0, Math.max(ratio, right - left), canvas.height);
    }
    pen.fillStyle = INK_ON_PHASES;
    for (const moment of this.data.faults) {
      const x = (canvas.width * (moment - motion.start)) / (motion.end || 1);
      pen.fillRect(Math.min(canvas.width - 3 * ratio, Math.max(0, x - ratio)), 0, 3 * ratio, canvas.height);
    }
  }
}

new Player(JSON.parse(document.getElementById("data").textContent));
