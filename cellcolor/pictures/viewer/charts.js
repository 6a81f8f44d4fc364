// Joint angles and both measures of conditioning over time, one strip each, with their limits.
"use strict";

const HIGH = 100, WIDE = 1000; // of a strip's drawing, which is stretched
const degrees = (angle) => `${((180 / Math.PI) * angle).toFixed(1)}°`;

function element(name, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// A drawing that is stretched over its place: a share of the width for each moment.
function stretched(...children) {
  const box = { viewBox: `0 0 ${WIDE} ${HIGH}`, preserveAspectRatio: "none", "aria-hidden": "true" };
  return element("svg", box, ...children);
}

class Charts {
  constructor(place, motion, chosen) {
    Object.assign(this, { place, motion });
    const { names, limits } = motion.data;
    this.strips = names.map((name, joint) => {
      const [low, high] = [limits.lower[joint], limits.upper[joint]]; // null without a limit
      const values = motion.joints.filter((_, k) => k % motion.count === joint), written = degrees;
      const marks = [low, high].filter((limit) => limit !== null);
      const bound = marks.length === 2 ? `${degrees(low)} to ${degrees(high)}` : "";
      return { name: name.replace(/_joint$/, "").replaceAll("_", " "), values, marks, written, bound };
    });
    for (const name of ["determinant", "manipulability"]) {
      const values = unpack(motion.data[name]), least = limits[name];
      const written = (value) => `${value.toPrecision(3)} m³`, marks = least === null ? [] : [least];
      const bound = least === null ? "" : `at least ${written(least)}`;
      this.strips.push({ name: name.replace("det", "task det"), values, marks, written, bound, stepped: true });
    }
    this.cursor = document.createElement("div");
    this.cursor.id = "cursor";
    place.replaceChildren(...this.strips.map((strip) => this.strip(strip)), this.cursor);
    const choose = (event) => {
      if (event.type === "pointermove" && !event.buttons) return;
      const box = place.getBoundingClientRect();
      chosen(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * motion.end);
    };
    place.addEventListener("pointerdown", choose);
    place.addEventListener("pointermove", choose);
  }

  // What is drawn of a joint: limits that are far away would flatten the curve.
  strip(strip) {
    const { motion } = this, { values, marks } = strip;
    const least = Math.min(...values), most = Math.max(...values), near = Math.max(0.15 * (most - least), 1e-6);
    const seen = marks.filter((mark) => mark > least - near && mark < most + near);
    const low = Math.min(least, ...seen) - 0.2 * near, high = Math.max(most, ...seen) + 0.2 * near;
    const x = (moment) => ((WIDE * moment) / (motion.end || 1)).toFixed(2);
    const y = (value) => (HIGH - (HIGH * (value - low)) / (high - low)).toFixed(2);
    const points = Array.from(motion.times, (moment, frame) => {
      const before = strip.stepped && frame ? `${x(moment)},${y(values[frame - 1])} ` : "";
      return `${before}${x(moment)},${y(values[frame])}`;
    });
    const row = document.createElement("div"), head = document.createElement("div");
    const [name, value, bound] = [strip.name, "", strip.bound].map((text) => {
      const part = document.createElement("span");
      part.textContent = text;
      return part;
    });
    head.append(name, value, bound);
    row.append(head, stretched(
      ...motion.bars((state) => ["move", "", "unplanned"][state]),
      ...seen.map((mark) => element("path", { class: "limit", d: `M0 ${y(mark)}H${WIDE}` })),
      element("polyline", { points: points.join(" ") }),
    ));
    strip.said = value;
    return row;
  }

  draw(now) {
    const { motion } = this, [frame, share] = motion.at(now);
    this.cursor.style.left = `${(100 * now) / (motion.end || 1)}%`;
    const next = Math.min(frame + 1, motion.times.length - 1);
    for (const { values, stepped, said, written } of this.strips)
      said.textContent = written(values[frame] + (stepped ? 0 : share * (values[next] - values[frame])));
  }
}
