// One motion: where its points are at any time, and what its report says is playing.

const SMOOTHING_S = 1.0;
const TINT_EASE_FRAMES = 8;

function bytesFromBase64(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i += 1) bytes[i] = binary.charCodeAt(i);
  return bytes.buffer;
}

class Motion {
  constructor(data) {
    Object.assign(this, data);
    this.path = new Float32Array(bytesFromBase64(data.path));
    this.offsets = new Int16Array(bytesFromBase64(data.offsets));
    this.duration = (this.nFrames - 1) * this.frameTime;
    this.points = new Float32Array(3 * this.nPoints);
    this.centres = new Float32Array(3 * this.balls.length);
    this.focus = this.smoothPath();
  }

  // Where a camera that follows looks over the ground: means of the path over one second; x and z of each frame.
  smoothPath() {
    const reach = Math.max(Math.round(SMOOTHING_S / 2 / this.frameTime), 1);
    const last = this.nFrames - 1;
    const result = new Float32Array(2 * this.nFrames);
    for (const [axis, source] of [[0, 0], [1, 2]]) {
      let sum = 0;
      for (let i = -reach - 1; i < reach; i += 1) sum += this.path[3 * clamp(i, 0, last) + source];
      for (let i = 0; i <= last; i += 1) {
        sum += this.path[3 * Math.min(i + reach, last) + source] - this.path[3 * Math.max(i - reach - 1, 0) + source];
        result[2 * i + axis] = sum / (2 * reach + 1);
      }
    }
    return result;
  }

  // The number in its file of a frame, and back.
  fileFrame(frame) {
    return this.firstFrame + this.frameStep * frame;
  }

  frameOf(fileFrame) {
    return (fileFrame - this.firstFrame) / this.frameStep;
  }

  // When the first frame is shown, counted from the beginning of the file.
  get begin() {
    return this.frameOf(0) * -this.frameTime;
  }

  frameAt(time) {
    return clamp(Math.floor(time / this.frameTime + 1e-6), 0, this.nFrames - 1);
  }

  // Puts the points and the balls where they are at a time; between two frames, if `between`, else at the frame.
  moveTo(time, between) {
    const at = clamp(time / this.frameTime, 0, this.nFrames - 1);
    const frame = this.frameAt(time);
    const share = between ? at - frame : 0;
    const next = Math.min(frame + 1, this.nFrames - 1);
    const mixed = (array, stride, i) => {
      const now = array[stride * frame + i];
      return now + share * (array[stride * next + i] - now);
    };
    const stride = 3 * this.nPoints;
    const root = [0, 1, 2].map((axis) => mixed(this.path, 3, axis));
    for (let i = 0; i < stride; i += 1) this.points[i] = root[i % 3] + this.quantum * mixed(this.offsets, stride, i);
    this.balls.forEach(([a, b, ballShare], ball) => {
      for (let axis = 0; axis < 3; axis += 1) {
        const first = this.points[3 * a + axis];
        this.centres[3 * ball + axis] = first + ballShare * (this.points[3 * b + axis] - first);
      }
    });
    this.target = [mixed(this.focus, 2, 0), this.height / 2, mixed(this.focus, 2, 1)];
  }

  commandAt(frame) {
    let found = null;
    for (const command of this.commands) if (command.begin <= frame) found = command;
    return found;
  }

  // What each graph that runs plays: [{track, index, stretch}], the root graph first.
  playingAt(frame) {
    const playing = [];
    this.tracks.forEach((track, index) => {
      for (const stretch of track.stretches) {
        if (stretch.begin <= frame && frame < stretch.end) playing.push({ track, index, stretch });
      }
    });
    return playing;
  }

  // How much each joint has the colour of a graph below the root: Map from joint to [index of the graph, weight].
  tintsAt(frame) {
    const tints = new Map();
    for (const { track, index } of this.playingAt(frame)) {
      if (index === 0 || !track.joints.length) continue;
      const run = track.runs.find(([begin, end]) => begin <= frame && frame < end);
      const weight = clamp(Math.min(frame - run[0] + 1, run[1] - frame) / TINT_EASE_FRAMES, 0, 1);
      for (const joint of track.joints) tints.set(joint, [index, weight]);
    }
    return tints;
  }
}
