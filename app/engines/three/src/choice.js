// Chooses how to render on this device, in this scene: `yoro::choice` of the library, whose documentation has the rules, for
// any number of ways. Times are in milliseconds.

/** Frames whose times may still come. */
const REMEMBERED = 64;
/** The second turn is of ways whose pictures differ, which must not flicker. */
const SETTLING = 250, TURN = [125, 1000], MEASURING = 1000, WATCH = 2000;
/** Longer times between frames are pauses. */
const PAUSE = 1000;
/** The first frames of a turn do not count: caches are cold, and earlier frames are still being displayed. */
const UNCOUNTED_FRAMES = 3;
const TURN_FRAMES = 7, TURNS = 6, LATE_FRAMES = 16;
/** A way holds the display's rate up to this number of refreshes between frames. */
const MAX_REFRESHES = 1.25;
/** Without a timer and the display's rate, ways whose frames come at times that differ by less hold the same rate. */
const SAME_RATE = 0.05;
/** A choice changes if another way costs less than this share. */
const SWITCH_BELOW = 0.9;
/** The share of the time that measuring may cost. */
const OVERHEAD = 0.002;
const SHORTEST_REST = 3e4, LEAST_REST = 6e4, LONGEST_REST = 6e5;
/** A change of cost or pace that is worth another measurement. */
const DRIFT = 1.3;

const [SETTLES, MEASURES, COLLECTS, RESTS] = [0, 1, 2, 3];
/** What is watched counts for no way. */
const WATCHED = 'watched';

/** The mean of the middle half, or null for fewer than four times. */
function middle(times = []) {
  if (times.length < 4) return null;
  const sorted = times.slice().sort((a, b) => a - b);
  const quarter = sorted.length >> 2;
  const half = sorted.slice(quarter, sorted.length - quarter);
  return half.reduce((sum, time) => sum + time) / half.length;
}

/** Measures ways in turns, and chooses the cheapest one, or the best one that holds the display's rate. */
export class Chooser {
  /** From the best one on. */
  #ways = ['rendered', 'synthesized'];
  /** True if each way is better than the next one; otherwise the first two are equally good. */
  #isRanked = false;
  #phase = SETTLES;
  /** When the phase began; null if it has not. */
  #begin = null;
  /** 0 while nothing is measured. */
  #turn = 0;
  #turnBegin = 0;
  /** Frames of the turn, or frames that are still waited for. */
  #count = 0;
  #until = 0;
  /** What the times of the last frames count for. */
  #tags = [];
  #last = null;
  #refresh = 0;
  /** By way, and of what is watched. */
  #costs = {};
  #intervals = {};
  #watchBegin = null;
  #first = null;
  #way = 'synthesized';
  #choice = null;

  constructor() {
    this.sceneChanged();
  }

  /**
   * Measures again: for another scene, place, resolution or other ways.
   *
   * @param {string[]} [ways] - From the best one on.
   * @param {boolean} [isRanked] - True if the first one is better than the second one, and not only dearer.
   */
  sceneChanged(ways = this.#ways, isRanked = this.#isRanked) {
    this.#ways = ways;
    this.#isRanked = isRanked;
    if (!ways.includes(this.#way)) this.#way = ways[1];
    this.#phase = SETTLES;
    this.#turn = 0;
    this.#begin = this.#last = null;
    this.#choose(this.#way, 'unmeasured');
  }

  /** The last choice: way, reason and, if they could be compared, the times of all ways. */
  get choice() {
    return this.#choice;
  }

  /** The way to make the next frame. */
  get way() {
    const ways = this.#ways;
    return ways[(ways.indexOf(this.#way) + this.#turn) % ways.length];
  }

  /**
   * Counts a frame.
   *
   * @param {number} now - The time.
   * @param {number} refresh - The display's refreshes per second, or 0 if unknown.
   * @param {string|null} rendered - How the frame was made, or null if it counts for no way.
   * @param {[number, number]|null} cost - How many frames ago was a frame whose GPU time has become known, and that time.
   */
  endFrame(now, refresh, rendered, cost) {
    const interval = this.#last === null ? null : now - this.#last;
    this.#last = now;
    const tags = this.#tags, phase = this.#phase;
    const isPause = interval > PAUSE;
    let tag = null;
    if (!isPause && rendered === this.way) {
      if (phase === MEASURES && this.#count >= UNCOUNTED_FRAMES) tag = rendered;
      else if (phase === RESTS) tag = WATCHED;
    }
    tags.push(tag);
    if (tags.length > REMEMBERED) tags.shift();
    if (isPause) {
      if (phase === RESTS) return this.#watch();
      this.#phase = SETTLES;
      this.#turn = 0;
      this.#begin = now;
      return;
    }
    // Without a display's pace, the time between frames says nothing about the cost of those that are watched.
    if (interval !== null && tag !== null && (tag !== WATCHED || refresh > 0)) {
      (this.#intervals[tag] ??= []).push(interval);
      this.#refresh = refresh;
    }
    const [ago, ms] = cost ?? [];
    const of = tags.at(-1 - ago);
    if (of && ms > 0 && ms < Infinity) (this.#costs[of] ??= []).push(ms);
    this.#proceed(now);
  }

  /** Begins the next turn or phase, if it is time. */
  #proceed(now) {
    if (this.#phase === SETTLES) {
      this.#begin ??= now;
      if (now - this.#begin >= SETTLING) this.#measure(now);
    } else if (this.#phase === MEASURES) {
      const n = this.#ways.length;
      if (++this.#count < TURN_FRAMES || now - this.#turnBegin < TURN[Number(n > 2)]) return;
      this.#turnBegin = now;
      this.#count = 0;
      if (++this.#turn < TURNS || this.#turn % n > 0 || now - this.#begin < MEASURING) return;
      // Of pictures that differ, the last one stays until one is chosen.
      this.#turn = n > 2 ? this.#turn - 1 : 0;
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
    this.#costs = {};
    this.#intervals = {};
    this.#tags = [];
    this.#phase = MEASURES;
    this.#begin = this.#turnBegin = now;
    this.#turn = this.#count = this.#refresh = 0;
  }

  /** Chooses, once the times of all frames are known or the wait for them is over. */
  #collect(now) {
    const isMissing = (way) => !(this.#costs[way]?.length >= this.#intervals[way]?.length);
    if (this.#count-- > 0 && this.#ways.some(isMissing)) return;
    const took = now - this.#begin;
    this.#compare();
    const { costs, reason } = this.#choice;
    // Pictures that differ are seen.
    let rest = this.#ways.length > 2 || reason === 'both hold the rate' ? LONGEST_REST : LEAST_REST;
    if (costs) {
      const times = Object.values(costs);
      const more = (Math.max(...times) / Math.min(...times) - 1) / 2;
      rest = Math.min(Math.max(took * more / OVERHEAD, rest), LONGEST_REST);
    }
    this.#watch();
    this.#first = null;
    this.#turn = 0;
    this.#phase = RESTS;
    this.#begin = now;
    this.#until = now + rest;
  }

  #compare() {
    const ways = this.#ways, refresh = this.#refresh;
    const ofAll = (times) => {
      const all = {};
      for (const way of ways) all[way] = middle(times[way]);
      return ways.some((way) => all[way] === null) ? null : all;
    };
    const known = ofAll(this.#costs), intervals = ofAll(this.#intervals);
    if (!intervals) return this.#choose(this.#way, 'incomparable');
    const rank = (way) => Math.max(ways.indexOf(way), Number(!this.#isRanked));
    const holding = ways.filter((way) => intervals[way] * refresh <= 1000 * MAX_REFRESHES);
    const good = refresh > 0 ? holding.filter((way) => rank(way) === rank(holding[0])) : [];
    if (good.length === 1) return this.#choose(good[0], 'holds the rate', intervals);
    const open = good.length > 0 ? good : ways, costs = known ?? intervals;
    const way = open.includes(this.#way) ? this.#way : open[0];
    const cheapest = open.reduce((a, b) => (costs[b] < costs[a] ? b : a));
    const [least, most] = [Math.min, Math.max].map((pick) => pick(...open.map((each) => costs[each])));
    if (!known && (good.length > 0 || most - least < SAME_RATE * most)) return this.#choose(way, 'both hold the rate');
    const isCheaper = least < costs[way] * (this.#choice.reason === 'unmeasured' ? 1 : SWITCH_BELOW);
    return this.#choose(isCheaper ? cheapest : way, isCheaper || costs[way] === least ? 'cheaper' : 'similar', costs);
  }

  #choose(way, reason, costs = null) {
    this.#way = way;
    this.#choice = { way, reason, costs };
  }

  /** Begins a window of frames that are watched. */
  #watch() {
    this.#watchBegin = null;
    for (const all of [this.#costs, this.#intervals]) all[WATCHED] = [];
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
