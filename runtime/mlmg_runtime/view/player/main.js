// The player: state, keys, buttons, and one loop that draws when something has changed.

const SPEEDS = [0.1, 4];
const root = document.documentElement;
const byId = (id) => document.getElementById(id);

function fail(message, state) {
  root.dataset.state = state;
  byId("message").hidden = false;
  byId("message").textContent = message;
}

class Player {
  constructor(data, renderer) {
    this.renderer = renderer;
    this.colours = data.colours;
    this.motions = data.scenes.map((scene) => new Motion(scene));
    this.several = this.motions.length > 1;
    this.duration = Math.max(...this.motions.map((motion) => motion.duration), 1e-3);
    this.frameTime = this.motions[0].frameTime;
    this.ribbons = this.motions.map((motion) => renderer.ribbon(motion));
    this.canvas = byId("canvas");
    this.camera = new Camera(this.canvas, () => this.touch());
    this.labels = new Labels(byId("labels"), this.motions, this.colours);
    this.timeline = new Timeline(byId("timeline"), this.motions, this.duration, this.colours, (time) => this.seek(time));
    this.on = { loop: true, follow: true, path: this.motions.some(goesSomewhere), bones: false, together: false };
    this.time = 0;
    this.speed = 1;
    this.playing = false;
    document.body.classList.toggle("several", this.several);
    this.readAddress();
    this.listen();
    this.showToggles();
    requestAnimationFrame((now) => this.tick(now));
  }

  // #frame=73&yaw=30&pitch=10&zoom=0.5&bones=1&together=1&play=0: a place to start from; a frame stands still.
  readAddress() {
    const query = new URLSearchParams(location.search || location.hash.slice(1));
    const number = (key) => (query.has(key) && Number.isFinite(Number(query.get(key))) ? Number(query.get(key)) : null);
    for (const [key, scale] of [["yaw", Math.PI / 180], ["pitch", Math.PI / 180], ["zoom", 1]]) {
      if (number(key) !== null) this.camera[key] = scale * number(key);
    }
    for (const key of Object.keys(this.on)) if (query.has(key)) this.on[key] = query.get(key) !== "0";
    if (number("frame") !== null) this.seek(this.motions[0].frameOf(number("frame")) * this.frameTime);
    this.setPlaying(query.has("play") ? query.get("play") !== "0" : !query.has("frame"));
  }

  listen() {
    for (const button of document.querySelectorAll("[data-do]")) {
      button.addEventListener("click", () => this.act(button.dataset.do));
    }
    byId("speed").addEventListener("input", (event) => this.setSpeed(10 ** Number(event.target.value)));
    addEventListener("keydown", (event) => this.key(event));
    addEventListener("resize", () => this.touch());
    addEventListener("hashchange", () => { this.readAddress(); this.showToggles(); });
    this.canvas.addEventListener("dblclick", () => this.act("reset"));
    new ResizeObserver(() => this.touch()).observe(this.canvas);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open) return;
    if (event.target.id === "speed" && event.key.startsWith("Arrow")) return;
    if (event.target.tagName === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
    const actions = {
      " ": "play", Home: "first", End: "last", ArrowLeft: "back", ArrowRight: "on", ArrowUp: "faster", ArrowDown: "slower",
      "[": "commandBefore", "]": "commandAfter", f: "follow", p: "path", b: "bones", l: "loop", v: "together", r: "reset", "?": "help",
    };
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    this.act(action, event.shiftKey ? 10 : 1);
  }

  act(action, times = 1) {
    if (action in this.on) {
      this.toggle(action);
      return;
    }
    const actions = {
      play: () => this.setPlaying(!this.playing),
      first: () => this.seek(0),
      last: () => this.step(Infinity),
      back: () => this.step(-times),
      on: () => this.step(times),
      faster: () => this.setSpeed(this.speed * 1.25),
      slower: () => this.setSpeed(this.speed / 1.25),
      commandBefore: () => this.goToCommand(-1),
      commandAfter: () => this.goToCommand(1),
      reset: () => this.camera.reset(),
      help: () => byId("help").showModal(),
    };
    actions[action]();
    this.touch();
  }

  toggle(name) {
    if (name === "together" && !this.several) return;
    this.on[name] = !this.on[name];
    if (name === "follow" && !this.on.follow) this.fixed = this.motions.map((motion) => motion.target);
    this.showToggles();
  }

  showToggles() {
    for (const button of document.querySelectorAll(".toggle")) {
      button.setAttribute("aria-pressed", String(this.on[button.dataset.do]));
    }
    this.touch();
  }

  setPlaying(playing) {
    if (playing && this.time >= this.duration && !this.on.loop) this.time = 0;
    this.playing = playing;
    document.body.classList.toggle("playing", playing);
    this.touch();
  }

  setSpeed(speed) {
    this.speed = clamp(speed, ...SPEEDS);
    if (Math.abs(Math.log(this.speed)) < 0.04) this.speed = 1;
    byId("speed").value = Math.log10(this.speed);
    byId("rate").textContent = `${Number(this.speed.toPrecision(2))}×`;
  }

  seek(time) {
    this.time = clamp(time, 0, this.duration);
    this.touch();
  }

  step(frames) {
    this.setPlaying(false);
    const last = Math.round(this.duration / this.frameTime);
    this.seek(clamp(Math.floor(this.time / this.frameTime + 1e-6) + frames, 0, last) * this.frameTime);
  }

  goToCommand(way) {
    const starts = this.motions.flatMap((motion) => motion.commands.map((command) => command.begin * motion.frameTime));
    const times = [0, ...starts, this.duration].sort((a, b) => a - b);
    const gap = this.frameTime / 2;
    const found = way > 0 ? times.find((time) => time > this.time + gap) : times.findLast((time) => time < this.time - gap);
    if (found !== undefined) this.seek(found);
  }

  touch() {
    this.changed = true;
  }

  tick(now) {
    if (this.playing && this.before !== undefined) this.advance((this.speed * (now - this.before)) / 1000);
    this.before = now;
    if (this.changed) {
      this.changed = false;
      this.draw();
    }
    requestAnimationFrame((next) => this.tick(next));
  }

  advance(seconds) {
    this.time += Math.min(seconds, 0.25 * SPEEDS[1]);
    if (this.time > this.duration) {
      if (this.on.loop) this.time %= this.duration;
      else {
        this.time = this.duration;
        this.setPlaying(false);
      }
    }
    this.touch();
  }

  draw() {
    const pixels = Math.min(devicePixelRatio || 1, 2);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    const size = [Math.round(width * pixels), Math.round(height * pixels)];
    if (this.canvas.width !== size[0] || this.canvas.height !== size[1]) [this.canvas.width, this.canvas.height] = size;
    for (const motion of this.motions) motion.moveTo(this.time, this.playing);
    this.renderer.clear(this.canvas.width, this.canvas.height);
    const boxes = this.boxes(width, height);
    if (this.on.together) this.drawPane([0, 0, width, height], this.motions.map((_, index) => index), pixels, height);
    else this.motions.forEach((_, index) => this.drawPane(boxes[index], [index], pixels, height));
    this.labels.place(boxes, this.on.together ? this.motions.map((_, index) => this.accent(index)) : null);
    this.motions.forEach((motion, index) => this.labels.show(index, motion, motion.frameAt(this.time)));
    this.showTime();
    root.dataset.state = "ready";
    root.dataset.frame = this.motions[0].fileFrame(this.motions[0].frameAt(this.time));
  }

  // The part of the window of each file: [left, top, width, height], in rows of panes that are taller than wide.
  boxes(width, height) {
    const n = this.motions.length;
    const columns = clamp(Math.round(Math.sqrt((1.3 * n * width) / height)), 1, n);
    const rows = Math.ceil(n / columns);
    return this.motions.map((_, index) => [
      ((index % columns) * width) / columns, (Math.floor(index / columns) * height) / rows, width / columns, height / rows,
    ]);
  }

  drawPane([left, top, width, height], indices, pixels, windowHeight) {
    const motions = indices.map((index) => this.motions[index]);
    const targets = indices.map((index) => (this.on.follow || !this.fixed ? this.motions[index].target : this.fixed[index]));
    const target = scaled(targets.reduce(add), 1 / targets.length);
    const spread = Math.max(...targets.map((other) => Math.hypot(other[0] - target[0], other[2] - target[2])));
    const tall = Math.max(...motions.map((motion) => motion.height));
    const heading = motions[0].heading;
    const view = this.camera.view(target, heading, width / height, 0.76 * tall + 0.8 * spread);
    const box = [left, windowHeight - top - height, width, height].map((side) => Math.round(side * pixels));
    const capsules = new Float32Array(indices.flatMap((index) => this.capsules(index)));
    const paths = this.on.path
      ? indices.map((index) => ({
        ribbon: this.ribbons[index],
        now: this.motions[index].frameAt(this.time),
        colour: this.accent(this.on.together ? index : 0),
      }))
      : [];
    this.renderer.pane(box, view, this.light(heading), capsules, paths, this.spot(motions));
  }

  // What throws shadows: the middle of all figures, and a radius that holds them and most of their shadows.
  spot(motions) {
    const middles = motions.map((motion) => this.middle(motion));
    const middle = scaled(middles.reduce(add), 1 / middles.length);
    const spread = Math.max(...middles.map((other) => Math.hypot(...subtract(other, middle))));
    return { middle, radius: spread + 1.15 * Math.max(...motions.map((motion) => motion.height)) };
  }

  middle(motion) {
    const at = 3 * motion.root;
    return [motion.points[at], 0.5 * motion.height, motion.points[at + 2]];
  }

  // From above the left shoulder of the camera as it stands at first.
  light(heading) {
    const yaw = heading + FIRST_VIEW.yaw;
    const across = [Math.cos(yaw), 0, -Math.sin(yaw)];
    const back = [Math.sin(yaw), 0, Math.cos(yaw)];
    return normalized(add(add(scaled(across, -0.55), scaled(back, 0.49)), [0, 1.15, 0]));
  }

  accent(index) {
    return this.colours.accents[index % this.colours.accents.length];
  }

  // Eleven numbers for each capsule of a figure: two balls and a colour.
  capsules(index) {
    const motion = this.motions[index];
    const tints = motion.tintsAt(motion.frameAt(this.time));
    const mix = (a, b, share) => a.map((part, i) => part + share * (b[i] - part));
    const own = this.on.together ? mix(this.colours.body, this.accent(index), 0.6) : this.colours.body;
    const colour = (joint) => {
      const tint = tints.get(joint);
      return tint ? mix(own, this.accent(tint[0]), tint[1]) : own;
    };
    const point = (array, at) => [array[3 * at], array[3 * at + 1], array[3 * at + 2]];
    if (this.on.bones) {
      const size = motion.height / 1.7;
      return motion.bones.flatMap(([parent, child]) => [
        ...point(motion.points, parent), 0.018 * size, ...point(motion.points, child), 0.009 * size, ...colour(parent),
      ]);
    }
    return motion.capsules.flatMap(([first, second, joint]) => [
      ...point(motion.centres, first), motion.balls[first][3],
      ...point(motion.centres, second), motion.balls[second][3],
      ...colour(joint),
    ]);
  }

  showTime() {
    const motion = this.motions.reduce((a, b) => (b.duration > a.duration ? b : a));
    const [now, end] = [this.time, this.duration].map((time) => (motion.begin + time).toFixed(2));
    const seconds = `${now} / ${end} s`;
    const frames = `frame ${motion.fileFrame(motion.frameAt(this.time))} / ${motion.fileFrame(motion.nFrames - 1)}`;
    const faint = document.createElement("span");
    faint.textContent = frames;
    byId("clock").replaceChildren(seconds, faint);
    this.timeline.show(this.time, `${seconds}, ${frames}`);
  }
}

function goesSomewhere(motion) {
  const far = (axis) => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = axis; i < motion.focus.length; i += 2) {
      low = Math.min(low, motion.focus[i]);
      high = Math.max(high, motion.focus[i]);
    }
    return high - low;
  };
  return Math.hypot(far(0), far(1)) > 2;
}

addEventListener("error", (event) => fail(`The player failed: ${event.message}`, "error"));

function start() {
  let renderer;
  const data = JSON.parse(byId("data").textContent);
  try {
    renderer = new Renderer(byId("canvas"), data.colours);
  } catch (error) {
    if (!(error instanceof NoWebGL)) throw error;
    fail("This player draws with WebGL 2, which this browser does not offer, or which is switched off.", "no-webgl");
    return;
  }
  new Player(data, renderer);
}

start();
