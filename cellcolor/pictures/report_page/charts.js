// Joint angles and both measures of conditioning over time, one strip each, with their limits.
"use strict";

const CONTACT = "#00508F", MOVE = "#E69F00", BAD = "#CC3311", SOFT = "#5A6472";
const degrees = (angle) => `${((180 / Math.PI) * angle).toFixed(1)}°`;

// What is drawn of a joint: limits that are far away would flatten the curve.
function within(least, most, low, high) {
  const near = Math.max(0.15 * (most - least), 0.1);
  return { low: Math.max(low ?? -Infinity, least - near), high: Math.min(high ?? Infinity, most + near) };
}

class Charts {
  constructor(canvas, data, motion, chosen) {
    Object.assign(this, { canvas, data, motion });
    const { limits } = data;
    this.strips = data.joint_names.map((name, joint) => {
      const values = motion.joints.filter((_, k) => k % motion.count === joint);
      const [low, high] = [limits.lower[joint], limits.upper[joint]];  // null without a limit
      return {
        name: name.replace(/_joint$/, "").replaceAll("_", " "),
        values,
        ...within(Math.min(...values), Math.max(...values), low, high),
        marks: [low, high].filter((limit) => limit !== null),
        written: degrees,
        stepped: false,
      };
    });
    for (const name of ["determinant", "manipulability"]) {
      const values = unpack(data.frames[name]), least = limits[name];
      const most = Math.max(...values, least || 0);
      this.strips.push({
        name: name === "determinant" ? "task determinant" : name,
        values,
        low: 0,
        high: most,
        marks: least === null ? [] : [least],
        written: (value) => `${value.toPrecision(3)} m³`,
        stepped: true,
      });
    }
    const choose = (event) => {
      if (event.type === "pointermove" && !event.buttons) return;
      const box = canvas.getBoundingClientRect();
      const share = (event.clientX - box.left) / box.width;
      chosen(Math.min(1, Math.max(0, share)) * motion.end);
    };
    canvas.addEventListener("pointerdown", choose);
    canvas.addEventListener("pointermove", choose);
    this.fit = false;
    new ResizeObserver(() => this.resized()).observe(canvas.parentElement);
    this.resized();
  }

  resized() {
    const ratio = Math.min(2, window.devicePixelRatio || 1), width = this.canvas.clientWidth;
    if (!width) return;
    this.step = width < 420 ? 62 : 70;
    const height = this.step * this.strips.length + 18;
    this.canvas.style.height = `${height}px`;
    Object.assign(this.canvas, { width: width * ratio, height: height * ratio });
    this.still = document.createElement("canvas");
    Object.assign(this.still, { width: width * ratio, height: height * ratio });
    const pen = this.still.getContext("2d");
    pen.scale(ratio, ratio);
    this.strips.forEach((strip, number) => this.drawStrip(pen, strip, number * this.step, width));
    pen.fillStyle = SOFT;
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "bottom";
    pen.fillText("0 s", 0, height);
    pen.textAlign = "right";
    pen.fillText(`${this.motion.end.toFixed(1)} s`, width, height);
    Object.assign(this, { width, height, ratio });
    this.draw(this.now || 0);
  }

  drawStrip(pen, strip, top, width) {
    const { motion } = this, head = 17, bottom = top + this.step - 5, high = top + head;
    const x = (moment) => (width * moment) / (motion.end || 1);
    let [low, most] = [strip.low, strip.high];
    if (this.fit) [low, most] = [Math.min(...strip.values), Math.max(...strip.values)];
    const pad = 0.06 * Math.max(most - low, 0.02 * (strip.high - strip.low));
    const y = (value) =>
      bottom - ((bottom - high) * (value - low + pad)) / (most - low + 2 * pad || 1);
    pen.fillStyle = "#F7F8FA";
    pen.fillRect(0, high, width, bottom - high);
    for (const [from, to, state] of motion.phases) {
      if (state === 1) continue;
      pen.fillStyle = state === 2 ? "rgba(204, 51, 17, 0.3)" : "rgba(230, 159, 0, 0.28)";
      pen.fillRect(x(from), high, Math.max(1, x(to) - x(from)), bottom - high);
    }
    pen.strokeStyle = BAD;
    pen.lineWidth = 1;
    pen.setLineDash([5, 3]);
    for (const mark of strip.marks) {
      if (y(mark) < high || y(mark) > bottom) continue;
      pen.beginPath();
      pen.moveTo(0, y(mark));
      pen.lineTo(width, y(mark));
      pen.stroke();
    }
    pen.setLineDash([]);
    pen.strokeStyle = CONTACT;
    pen.lineWidth = 1.4;
    pen.beginPath();
    motion.times.forEach((moment, frame) => {
      const value = y(strip.values[frame]);
      if (!frame) pen.moveTo(x(moment), value);
      else {
        if (strip.stepped) pen.lineTo(x(moment), y(strip.values[frame - 1]));
        pen.lineTo(x(moment), value);
      }
    });
    pen.stroke();
    pen.font = "12px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.fillStyle = "#1D2430";
    pen.textAlign = "left";
    pen.fillText(strip.name, 0, top + head / 2);
    pen.fillStyle = BAD;
    pen.textAlign = "right";
    const bound =
      strip.marks.length === 2
        ? `${degrees(strip.marks[0])} to ${degrees(strip.marks[1])}`
        : strip.marks.length
          ? `at least ${strip.written(strip.marks[0])}`
          : "";
    pen.fillText(bound, width, top + head / 2);
  }

  draw(now) {
    this.now = now;
    if (!this.still) return;
    const pen = this.canvas.getContext("2d"), { width, height, step, motion } = this;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    pen.scale(this.ratio, this.ratio);
    const x = (width * now) / (motion.end || 1);
    pen.strokeStyle = "#1D2430";
    pen.beginPath();
    pen.moveTo(x, 12);
    pen.lineTo(x, height - 18);
    pen.stroke();
    pen.font = "600 12px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.textAlign = "center";
    pen.fillStyle = "#1D2430";
    const [frame, share] = motion.at(now), next = Math.min(frame + 1, motion.times.length - 1);
    this.strips.forEach((strip, number) => {
      const before = strip.values[frame], after = strip.stepped ? before : strip.values[next];
      pen.fillText(strip.written(before + share * (after - before)), 0.46 * width, number * step + 9);
    });
  }
}
