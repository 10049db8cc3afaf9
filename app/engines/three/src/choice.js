// Chooses what is cheaper on this device, in this scene: `yoro::choice` of the library, whose documentation has the
// rules. Times are in milliseconds.

/** @typedef {'synthesized'|'rendered'} Way */

/** Frames whose times may still come. */
const REMEMBERED = 64;
const SETTLING = 250, TURN = 125, MEASURING = 1000, WATCH = 2000;
/** Longer times between frames are pauses. */
const PAUSE = 1000;
/** The first frames of a turn do not count: caches are cold, and earlier frames are still being displayed. */
const UNCOUNTED_FRAMES = 3;
const TURN_FRAMES = 7, TURNS = 6, LATE_FRAMES = 16, MAX_SAMPLES = 128;
/** A way holds the display's rate up to this number of refreshes between frames. */
const MAX_REFRESHES = 1.25;
/** Without a timer and the display's rate, ways whose frames come at times that differ by less hold the same rate. */
const SAME_RATE = 0.05;
/** A choice changes if the other way costs less than this share. */
const SWITCH_BELOW = 0.9;
/** The share of the time that measuring may cost. */
const OVERHEAD = 0.002;
const SHORTEST_REST = 3e4, LEAST_REST = 6e4, LONGEST_REST = 6e5;
/** A change of cost or pace that is worth another measurement. */
const DRIFT = 1.3;

const [SETTLES, MEASURES, COLLECTS, RESTS] = [0, 1, 2, 3];
/** Indices of what is measured; what is watched counts for neither way. */
const WAYS = /** @type {Way[]} */ (['rendered', 'synthesized']);
const WATCHED = 2;

/** The mean of the middle half, or null for fewer than four times. */
function middle(times) {
  if (times.length < 4) return null;
  const sorted = times.slice().sort((a, b) => a - b);
  const quarter = sorted.length >> 2;
  const half = sorted.slice(quarter, sorted.length - quarter);
  return half.reduce((sum, time) => sum + time) / half.length;
}

const add = (times, ms) => {
  if (times.length < MAX_SAMPLES) times.push(ms);
};

/** Measures both ways in turns, and chooses the cheaper one. */
export class Chooser {
  #phase = SETTLES;
  /** When the phase began; null if it has not. */
  #begin = null;
  #turn = 0;
  #turnBegin = 0;
  /** Frames of the turn, or frames that are still waited for. */
  #count = 0;
  #until = 0;
  /** What the times of the last frames count for. */
  #tags = [];
  #frames = 0;
  #last = null;
  #refresh = 0;
  /** By index: both ways, and what is watched. */
  #costs = [[], [], []];
  #intervals = [[], [], []];
  #watchBegin = null;
  #first = null;
  #way = 1;
  #choice = null;

  constructor() {
    this.sceneChanged();
  }

  /** Measures again: for another scene, place or resolution. */
  sceneChanged() {
    this.#phase = SETTLES;
    this.#begin = this.#last = null;
    this.#choose(this.#way, 'unmeasured');
  }

  /** The last choice: way, reason and, if they could be compared, the times of both ways. */
  get choice() {
    return this.#choice;
  }

  /** The way to make the next frame. */
  get way() {
    return WAYS[this.#next];
  }

  get isMeasuring() {
    return this.#phase !== RESTS;
  }

  get #next() {
    return this.#phase === MEASURES && this.#turn % 2 === 1 ? 1 - this.#way : this.#way;
  }

  /**
   * Counts a frame.
   *
   * @param {number} now - The time.
   * @param {number} refresh - The display's refreshes per second, or 0 if unknown.
   * @param {Way|null} rendered - How the frame was made, or null if it counts for no way.
   * @param {[number, number]|null} cost - How many frames ago was a frame whose GPU time has become known, and that time.
   */
  endFrame(now, refresh, rendered, cost) {
    const interval = this.#last === null ? null : now - this.#last;
    this.#last = now;
    let tag = null;
    if (interval !== null && !(interval >= 0 && interval < PAUSE)) {
      if (this.isMeasuring) {
        this.#phase = SETTLES;
        this.#begin = now;
      } else {
        this.#watch();
      }
      this.#tags[this.#frames++ % REMEMBERED] = tag;
      return;
    }
    if (rendered === this.way) {
      if (this.#phase === MEASURES && this.#count >= UNCOUNTED_FRAMES) tag = this.#next;
      else if (this.#phase === RESTS) tag = WATCHED;
    }
    this.#tags[this.#frames % REMEMBERED] = tag;
    // Without a display's pace, the time between frames says nothing about the cost of those that are watched.
    if (interval !== null && tag !== null && (tag !== WATCHED || refresh > 0)) {
      add(this.#intervals[tag], interval);
      this.#refresh = refresh;
    }
    if (cost) {
      const [ago, ms] = cost;
      const of = ago < REMEMBERED && ago <= this.#frames ? this.#tags[(this.#frames - ago) % REMEMBERED] ?? null : null;
      if (of !== null && ms > 0 && ms < Infinity) add(this.#costs[of], ms);
    }
    this.#frames++;
    this.#proceed(now);
  }

  /** Begins the next turn or phase, if it is time. */
  #proceed(now) {
    if (this.#phase === SETTLES) {
      this.#begin ??= now;
      if (now - this.#begin >= SETTLING) this.#measure(now);
    } else if (this.#phase === MEASURES) {
      if (++this.#count < TURN_FRAMES || now - this.#turnBegin < TURN) return;
      this.#turnBegin = now;
      this.#count = 0;
      if (++this.#turn < TURNS || this.#turn % 2 === 1 || now - this.#begin < MEASURING) return;
      this.#phase = COLLECTS;
      this.#count = LATE_FRAMES;
      this.#collect(now);
    } else if (this.#phase === COLLECTS) {
      this.#collect(now);
    } else if ((this.#hasDrifted(now) && now - this.#begin >= SHORTEST_REST) || now >= this.#until) {
      this.#measure(now);
    }
  }

  #measure(now) {
    this.#costs = [[], [], []];
    this.#intervals = [[], [], []];
    this.#tags = [];
    this.#phase = MEASURES;
    this.#begin = this.#turnBegin = now;
    this.#turn = this.#count = this.#refresh = 0;
  }

  /** Chooses, once the times of all frames are known or the wait for them is over. */
  #collect(now) {
    const isMissing = (way) => this.#costs[way].length < this.#intervals[way].length;
    if (this.#count-- > 0 && (isMissing(0) || isMissing(1))) return;
    const took = now - this.#begin;
    this.#compare();
    const { costs, reason } = this.#choice;
    let rest = reason === 'both hold the rate' ? LONGEST_REST : LEAST_REST;
    if (costs) {
      const [a, b] = [costs.rendered, costs.synthesized];
      const more = (Math.max(a, b) / Math.min(a, b) - 1) / 2;
      rest = Math.min(Math.max(took * more / OVERHEAD, LEAST_REST), LONGEST_REST);
    }
    this.#watch();
    this.#first = null;
    this.#phase = RESTS;
    this.#begin = now;
    this.#until = now + rest;
  }

  #compare() {
    const ofBoth = (times) => {
      const [a, b] = [middle(times[0]), middle(times[1])];
      return a !== null && b !== null ? [a, b] : null;
    };
    const known = ofBoth(this.#costs), intervals = ofBoth(this.#intervals);
    const way = this.#way;
    if (!intervals) return this.#choose(way, 'incomparable');
    if (this.#refresh > 0) {
      const [first, second] = intervals.map((ms) => ms * this.#refresh <= 1000 * MAX_REFRESHES);
      if (first !== second) return this.#choose(Number(second), 'holds the rate', intervals);
      if (!known && first) return this.#choose(way, 'both hold the rate');
    }
    const [a, b] = intervals;
    if (!known && Math.abs(a - b) < SAME_RATE * a) return this.#choose(way, 'both hold the rate');
    const costs = known ?? intervals;
    const [now, other] = [costs[way], costs[1 - way]];
    const isCheaper = other < now * (this.#choice.reason === 'unmeasured' ? 1 : SWITCH_BELOW);
    return this.#choose(isCheaper ? 1 - way : way, isCheaper || now <= other ? 'cheaper' : 'similar', costs);
  }

  #choose(way, reason, costs = null) {
    this.#way = way;
    this.#choice = { way: WAYS[way], reason, costs: costs && { rendered: costs[0], synthesized: costs[1] } };
  }

  /** Begins a window of frames that are watched. */
  #watch() {
    this.#watchBegin = null;
    this.#costs[WATCHED] = [];
    this.#intervals[WATCHED] = [];
  }

  /** True if a window ends now whose times differ from those of the first window. */
  #hasDrifted(now) {
    this.#watchBegin ??= now;
    if (now - this.#watchBegin < WATCH) return false;
    const times = [this.#costs, this.#intervals].map((all) => middle(all[WATCHED]));
    this.#watch();
    const first = this.#first ??= times;
    return times.some((time, i) => time !== null && first[i] !== null && (time > first[i] * DRIFT || time * DRIFT < first[i]));
  }
}
