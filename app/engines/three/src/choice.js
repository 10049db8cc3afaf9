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
/** Among more than two ways, it does with at most this share of late frames, and this room in its cost, or less if in use. */
const MAX_LATE = 0.05, ROOM = [0.8, 0.9];
/** Without a timer and the display's rate, ways whose frames come at times that differ by less hold the same rate. */
const SAME_RATE = 0.05;
/** A choice changes if another way costs less than this share. */
const SWITCH_BELOW = 0.9;
/** The share of the time that measuring may cost. */
const OVERHEAD = 0.002;
const MISSED_REST = 5e3, SHORTEST_REST = 3e4, LEAST_REST = 6e4, LONGEST_REST = 6e5;
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
  /** The time before which a way that misses the rate is not measured again. */
  #missedRest = MISSED_REST;
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
    this.#missedRest = MISSED_REST;
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
    } else if (this.#hasChanged(now) || now >= this.#until) {
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
    const costs = known ?? intervals, isNew = this.#choice.reason === 'unmeasured';
    const rank = (way) => Math.max(ways.indexOf(way), Number(!this.#isRanked));
    const holding = ways.filter((way) => refresh > 0 && intervals[way] * refresh <= 1000 * MAX_REFRESHES && this.#isPunctual(way));
    const roomy = holding.filter((way) => ways.length < 3 || !known || known[way] * refresh <= 1000 * ROOM[Number(way === this.#way && !isNew)]);
    const best = roomy.filter((way) => rank(way) === rank(roomy[0]));
    if (best.length === 1) return this.#choose(best[0], 'holds the rate', costs);
    const good = best.length > 0 ? best : holding;
    // Without samples only to hold a rate.
    const open = good.length > 0 ? good : ways.filter((way) => refresh > 0 || way !== 'aliased');
    const cheapest = open.reduce((a, b) => (costs[b] < costs[a] ? b : a));
    const least = costs[cheapest];
    const alike = open.filter((each) => good.length > 0 || costs[each] - least < SAME_RATE * least);
    const way = [this.#way, ...(known ? open : alike)].find((each) => open.includes(each));
    if (!known && alike.length > 1) return this.#choose(alike.includes(way) ? way : alike[0], 'both hold the rate');
    const isCheaper = least < costs[way] * (isNew ? 1 : SWITCH_BELOW);
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

  /** True unless pictures differ and too many frames of a way are late, which a display's queue hides from most of them. */
  #isPunctual(way) {
    const times = this.#intervals[way];
    return this.#ways.length < 3 || times.filter((time) => time * this.#refresh > 1500).length <= MAX_LATE * times.length;
  }

  /** True if a window ends now whose times differ from those of the first window, or that misses the rate. */
  #hasChanged(now) {
    this.#watchBegin ??= now;
    if (now - this.#watchBegin < WATCH) return false;
    const rested = now - this.#begin;
    const times = [this.#costs, this.#intervals].map((all) => middle(all[WATCHED]));
    const isLate = this.#choice.reason === 'holds the rate' && this.#way !== this.#ways.at(-1) && !this.#isPunctual(WATCHED);
    this.#watch();
    if (isLate && rested >= this.#missedRest) {
      this.#missedRest *= 2;
      return true;
    }
    const first = this.#first ??= times;
    return rested >= SHORTEST_REST && times.some((time, i) => time !== null && first[i] !== null && (time > first[i] * DRIFT || time * DRIFT < first[i]));
  }
}
