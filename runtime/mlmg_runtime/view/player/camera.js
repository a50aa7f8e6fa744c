// A camera that goes round the figure: mouse, wheel, fingers.

const FIELD_OF_VIEW = 0.45;
const FIRST_VIEW = { yaw: 0.6, pitch: 0.2, zoom: 1, pan: [0, 0, 0] };

class Camera {
  constructor(element, changed) {
    this.changed = changed;
    this.pointers = new Map();
    this.reset();
    element.addEventListener("pointerdown", (event) => this.press(event, element));
    element.addEventListener("pointermove", (event) => this.move(event));
    for (const kind of ["pointerup", "pointercancel"]) {
      element.addEventListener(kind, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.scale(Math.exp(clamp(event.deltaY, -200, 200) * 0.0015));
    }, { passive: false });
  }

  reset() {
    Object.assign(this, structuredClone(FIRST_VIEW));
  }

  press(event, element) {
    element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.pans = event.shiftKey || event.button > 0;
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [x, y] = [now[0] - before[0], now[1] - before[1]];
    if (this.pointers.size === 2) {
      const [, other] = [...this.pointers].find(([id]) => id !== event.pointerId);
      const apart = (point) => Math.max(Math.hypot(point[0] - other[0], point[1] - other[1]), 1);
      this.scale(apart(before) / apart(now));
      this.slide(x / 2, y / 2);
    } else if (this.pans) {
      this.slide(x, y);
    } else {
      this.yaw -= 0.008 * x;
      this.pitch = clamp(this.pitch + 0.006 * y, -0.1, 1.55);
    }
    this.pointers.set(event.pointerId, now);
    this.changed();
  }

  scale(factor) {
    this.zoom = clamp(this.zoom * factor, 0.15, 12);
    this.changed();
  }

  // Moves the target against the drag: across the view, and up. `pan` is in the camera's own directions.
  slide(x, y) {
    const metres = 0.0028 * this.zoom;
    this.pan = [this.pan[0] - metres * x, this.pan[1] + metres * y, 0];
  }

  // Matrices of the view on a target; `heading` is what yaw is measured from.
  view(target, heading, aspect, radius) {
    const yaw = heading + this.yaw;
    const right = [Math.cos(yaw), 0, -Math.sin(yaw)];
    const back = [Math.sin(yaw) * Math.cos(this.pitch), Math.sin(this.pitch), Math.cos(yaw) * Math.cos(this.pitch)];
    const centre = add(add(target, scaled(right, this.pan[0])), [0, this.pan[1], 0]);
    const distance = (this.zoom * radius * Math.max(1, 0.75 / aspect)) / Math.tan(FIELD_OF_VIEW / 2);
    const eye = add(centre, scaled(back, distance));
    eye[1] = Math.max(eye[1], 0.05);
    const near = Math.max(0.02 * distance, 0.02);
    const projection = perspective(FIELD_OF_VIEW, aspect, near, distance + 120);
    return { eye, target: centre, distance, matrix: multiply(projection, lookAt(eye, centre)) };
  }
}
