// Which endings of a server are too many.
const WITHIN_MS = 3 * 60 * 1000;
const AT_MOST = 4;

export class Endings {
  private times: number[] = [];

  /** Takes an ending; returns whether it is one too many within three minutes. */
  isTooMuch(now: number): boolean {
    this.times = [...this.times.filter((time) => now - time <= WITHIN_MS), now];
    return this.times.length > AT_MOST;
  }
}
