// The bar of time under the picture: a lane for the commands and one for each graph; press anywhere to go there.

class Timeline {
  constructor(element, motions, duration, colours, seek) {
    this.element = element;
    this.lanes = element.querySelector("#lanes");
    this.headElement = element.querySelector("#head");
    this.duration = duration;
    const named = motions.filter((motion) => motion.commands.length || motion.tracks.length);
    for (const motion of named) this.addStory(motion, colours, motions.length > 1);
    if (!named.length) this.bar = this.addLane("", "bar").appendChild(document.createElement("div"));
    if (this.bar) this.bar.className = "part";
    if (named.length) element.style.setProperty("--names", "min(22%, 120px)");
    const go = (event) => seek(this.timeAt(event.clientX));
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      go(event);
    });
    element.addEventListener("pointermove", (event) => {
      if (element.hasPointerCapture(event.pointerId)) go(event);
    });
  }

  addStory(motion, colours, several) {
    const prefix = several ? `${motion.name}: ` : "";
    if (motion.commands.length) {
      const lane = this.addLane(several ? motion.name : "Command");
      for (const { text, begin, arrive, end } of motion.commands) {
        if (end <= begin) continue;
        const part = this.addPart(lane, motion, begin, end, "command", text);
        const coming = part.insertBefore(document.createElement("i"), part.firstChild);
        coming.style.width = `${(100 * (arrive - begin)) / (end - begin)}%`;
      }
    }
    motion.tracks.forEach((track, index) => {
      const lane = this.addLane(prefix + track.graph);
      for (const { begin, end, text, kind } of track.stretches) {
        const part = this.addPart(lane, motion, begin, end, kind, text);
        part.style.setProperty("--colour", cssColour(colours.accents[index % colours.accents.length]));
      }
    });
  }

  addLane(name, kind = "") {
    const lane = this.lanes.appendChild(document.createElement("div"));
    lane.className = `lane ${kind}`;
    const label = lane.appendChild(document.createElement("span"));
    label.textContent = name;
    label.title = name;
    return lane.appendChild(document.createElement("div"));
  }

  addPart(lane, motion, begin, end, kind, text) {
    const part = lane.appendChild(document.createElement("div"));
    part.className = "part";
    part.classList.add(kind);
    part.title = text;
    part.style.left = `${(100 * begin * motion.frameTime) / this.duration}%`;
    part.style.width = `${(100 * (end - begin) * motion.frameTime) / this.duration}%`;
    part.appendChild(document.createElement("span")).textContent = text;
    return part;
  }

  // The stretch of the window, in pixels, that stands for the time.
  extent() {
    return this.lanes.querySelector(".lane > div").getBoundingClientRect();
  }

  timeAt(x) {
    const { left, width } = this.extent();
    return clamp((x - left) / width, 0, 1) * this.duration;
  }

  show(time, text) {
    const { left, width } = this.extent();
    const share = time / this.duration;
    this.headElement.style.left = `${left - this.element.getBoundingClientRect().left + share * width}px`;
    if (this.bar) this.bar.style.width = `${100 * share}%`;
    this.element.setAttribute("aria-valuemin", 0);
    this.element.setAttribute("aria-valuemax", this.duration.toFixed(2));
    this.element.setAttribute("aria-valuenow", time.toFixed(2));
    this.element.setAttribute("aria-valuetext", text);
  }
}
