// Chooses what is cheaper on this device, in this scene: `yoro::choice` of the library, whose documentation has the
// rules. Times are in milliseconds.

/** @typedef {'synthesized'|'rendered'} Way */

const REMEMBERED = 64;
const SETTLING = 250, TURN = 125, MEASURING = 1000, WATCH = 2000;
/** Longer times between frames are pauses. */
const PAUSE = 1000;
/** The first frames of a turn do not count: caches are cold, and earlier frames are still being displayed. */
const UNCOUNTED_FRAMES = 3;
const TURN_FRAMES = 7, TURNS = 6, LATE_FRAMES = 16, MAX_SAMPLES = 128;
/** A way holds the display's rate up to this number of refreshes between frames. */
const MAX_REFRESHES = 1.25;
/** A choice changes if the other way costs less than this share. */
const SWITCH_BELOW = 0.9;
/** The share of the time that measuring may cost. */
const OVERHEAD = 0.002;
const SHORTEST_REST = 30_000, REST = [60_000, 600_000];
/** A change of cost or pace that is worth another measurement. */
const DRIFT = 1.3;

/** @param {Way} way @return {Way} */
const otherThan = (way) => (way === 'rendered' ? 'synthesized' : 'rendered');

/** The mean of the middle half, or null for fewer than four times. */
function middle(times) {
  if (times.length < 4) return null;
  const sorted = [...times].sort((a, b) => a - b);
  const quarter = sorted.length >> 2;
  const half = sorted.slice(quarter, sorted.length - quarter);
  return half.reduce((sum, time) => sum + time, 0) / half.length;
}

const add = (times, ms) => {
  if (times.length < MAX_SAMPLES) times.push(ms);
};

/** Measures both ways in turns, and chooses the cheaper one. */
export class Chooser {
  constructor() {
    /** The last choice: way, reason and, if they could be compared, the times of both ways. */
    this.choice = { way: /** @type {Way} */ ('synthesized'), reason: 'unmeasured', costs: null };
    this.tags = new Array(REMEMBERED).fill(null);
    this.frames = 0;
    this.sceneChanged();
  }

  /** Measures again: for another scene, place or resolution. */
  sceneChanged() {
    this.phase = { name: 'settling', begin: null };
    this.choice = { way: this.choice.way, reason: 'unmeasured', costs: null };
    this.last = null;
  }

  /** The way to make the next frame. */
  get way() {
    const { phase, choice } = this;
    return phase.name === 'measuring' && phase.turn % 2 === 1 ? otherThan(choice.way) : choice.way;
  }

  get isMeasuring() {
    return this.phase.name !== 'resting';
  }

  /**
   * Counts a frame.
   *
   * @param {Object} end
   * @param {number} end.now - The time.
   * @param {number} end.refresh - The display's refreshes per second, or 0 if unknown.
   * @param {Way|null} end.rendered - How the frame was made, or null if it counts for no way.
   * @param {{framesAgo: number, ms: number}|null} end.cost - The GPU's time of this or an earlier frame, if it is known now.
   */
  endFrame({ now, refresh, rendered, cost }) {
    const interval = this.last === null ? null : now - this.last;
    this.last = now;
    if (interval !== null && !(interval >= 0 && interval < PAUSE)) {
      this.tags[this.frames++ % REMEMBERED] = null;
      if (this.isMeasuring) this.phase = { name: 'settling', begin: now };
      else this.watch = { ...this.watch, begin: null, costs: [], intervals: [] };
      return;
    }
    const { phase } = this;
    let tag = null;
    if (rendered === this.way) {
      if (phase.name === 'measuring' && phase.frames >= UNCOUNTED_FRAMES) tag = rendered;
      else if (phase.name === 'resting') tag = 'watched';
    }
    this.tags[this.frames % REMEMBERED] = tag;
    if (interval !== null && tag === 'watched') {
      if (refresh > 0) add(this.watch.intervals, interval);
    } else if (interval !== null && tag) {
      add(this.intervals[tag], interval);
      this.refresh = refresh;
    }
    if (cost && cost.framesAgo < REMEMBERED && cost.framesAgo <= this.frames && cost.ms > 0 && cost.ms < Infinity) {
      const of = this.tags[(this.frames - cost.framesAgo) % REMEMBERED];
      if (of) add(of === 'watched' ? this.watch.costs : this.costs[of], cost.ms);
    }
    this.frames++;
    this.proceed(now);
  }

  /** Begins the next turn or phase, if it is time. */
  proceed(now) {
    const { phase } = this;
    if (phase.name === 'settling') {
      phase.begin ??= now;
      if (now - phase.begin >= SETTLING) this.measure(now);
    } else if (phase.name === 'measuring') {
      if (++phase.frames < TURN_FRAMES || now - phase.turnBegin < TURN) return;
      const turns = phase.turn + 1;
      if (turns >= TURNS && turns % 2 === 0 && now - phase.begin >= MEASURING) {
        this.phase = { name: 'collecting', begin: phase.begin, left: LATE_FRAMES };
        this.collect(now);
      } else {
        Object.assign(phase, { turn: turns, turnBegin: now, frames: 0 });
      }
    } else if (phase.name === 'collecting') {
      this.collect(now);
    } else {
      const hasDrifted = this.hasDrifted(now);
      if (now >= phase.until || (now - phase.since >= SHORTEST_REST && hasDrifted)) this.measure(now);
    }
  }

  measure(now) {
    this.costs = { rendered: [], synthesized: [] };
    this.intervals = { rendered: [], synthesized: [] };
    this.refresh = 0;
    this.tags.fill(null);
    this.phase = { name: 'measuring', begin: now, turn: 0, turnBegin: now, frames: 0 };
  }

  /** Chooses, once the times of all frames are known or the wait for them is over. */
  collect(now) {
    const { phase, costs, intervals } = this;
    const isMissing = (way) => costs[way].length < intervals[way].length;
    if (phase.left-- > 0 && (isMissing('rendered') || isMissing('synthesized'))) return;
    this.choice = this.choose();
    const { costs: both, reason } = this.choice;
    let rest = SHORTEST_REST * 2;
    if (both) {
      const { rendered: a, synthesized: b } = both;
      const more = (Math.max(a, b) / Math.min(a, b) - 1) / 2;
      rest = Math.min(Math.max((now - phase.begin) * more / OVERHEAD, REST[0]), REST[1]);
    } else if (reason === 'both hold the rate') {
      rest = REST[1];
    }
    this.watch = { begin: null, costs: [], intervals: [], first: null };
    this.phase = { name: 'resting', since: now, until: now + rest };
  }

  choose() {
    const ofBoth = ({ rendered, synthesized }) => {
      const both = { rendered: middle(rendered), synthesized: middle(synthesized) };
      return both.rendered !== null && both.synthesized !== null ? both : null;
    };
    const known = ofBoth(this.costs), intervals = ofBoth(this.intervals);
    const { way, reason: before } = this.choice;
    if (!intervals) return { way, reason: 'incomparable', costs: null };
    if (this.refresh > 0) {
      const holds = (each) => intervals[each] * this.refresh <= 1000 * MAX_REFRESHES;
      if (holds('rendered') !== holds('synthesized')) {
        return { way: holds('rendered') ? 'rendered' : 'synthesized', reason: 'holds the rate', costs: intervals };
      }
      if (!known && holds('rendered')) return { way, reason: 'both hold the rate', costs: null };
    }
    const costs = known ?? intervals;
    const [now, other] = [costs[way], costs[otherThan(way)]];
    if (other < now * (before === 'unmeasured' ? 1 : SWITCH_BELOW)) return { way: otherThan(way), reason: 'cheaper', costs };
    return { way, reason: now <= other ? 'cheaper' : 'similar', costs };
  }

  /** True if a window ends now whose times differ from those of the first window. */
  hasDrifted(now) {
    const { watch } = this;
    watch.begin ??= now;
    if (now - watch.begin < WATCH) return false;
    const times = [middle(watch.costs), middle(watch.intervals)];
    const { first } = watch;
    this.watch = { begin: null, costs: [], intervals: [], first: first ?? times };
    return first !== null && times.some((time, i) => time !== null && first[i] !== null
      && (time > first[i] * DRIFT || time * DRIFT < first[i]));
  }
}
