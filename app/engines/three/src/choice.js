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

/** Makes what measures ways in turns, and chooses the cheapest one, or the best one that holds the display's rate. */
export function createChooser() {
  /** From the best one on. */
  let ways = ['rendered', 'synthesized'];
  /** True if each way is better than the next one; otherwise the first two are equally good. */
  let isRanked = false;
  let phase;
  /** When the phase began; null if it has not. */
  let begin;
  /** 0 while nothing is measured. */
  let turn;
  let turnBegin;
  /** Frames of the turn, or frames that are still waited for. */
  let count;
  let until;
  /** What the times of the last frames count for. */
  let tags = [];
  let last;
  let refresh;
  /** By way, and of what is watched. */
  let costs = {};
  let intervals = {};
  let watchBegin;
  let first;
  /** The time before which a way that misses the rate is not measured again. */
  let missedRest;
  let choice = { way: 'synthesized' };

  const choose = (way, reason, costs = null) => {
    choice = { way, reason, costs };
  };

  /** True unless pictures differ and too many frames of a way are late, which a display's queue hides from most of them. */
  const isPunctual = (way) => {
    const times = intervals[way];
    return ways.length < 3 || times.filter((time) => time * refresh > 1500).length <= MAX_LATE * times.length;
  };

  const compare = () => {
    const ofAll = (times) => {
      const all = {};
      for (const way of ways) all[way] = middle(times[way]);
      return ways.some((way) => all[way] === null) ? null : all;
    };
    const current = choice.way;
    const known = ofAll(costs), paces = ofAll(intervals);
    if (!paces) return choose(current, 'incomparable');
    const compared = known ?? paces, isNew = choice.reason === 'unmeasured';
    const rank = (way) => Math.max(ways.indexOf(way), Number(!isRanked));
    const holding = ways.filter((way) => refresh > 0 && paces[way] * refresh <= 1000 * MAX_REFRESHES && isPunctual(way));
    const roomy = holding.filter((way) => ways.length < 3 || !known || known[way] * refresh <= 1000 * ROOM[Number(way === current && !isNew)]);
    const best = roomy.filter((way) => rank(way) === rank(roomy[0]));
    if (best.length === 1) return choose(best[0], 'holds the rate', compared);
    const good = best.length > 0 ? best : holding;
    // Without samples only to hold a rate.
    const open = good.length > 0 ? good : ways.filter((way) => refresh > 0 || way !== 'aliased');
    const cheapest = open.reduce((a, b) => (compared[b] < compared[a] ? b : a));
    const least = compared[cheapest];
    const alike = open.filter((each) => good.length > 0 || compared[each] - least < SAME_RATE * least);
    const way = [current, ...(known ? open : alike)].find((each) => open.includes(each));
    if (!known && alike.length > 1) return choose(alike.includes(way) ? way : alike[0], 'both hold the rate');
    const isCheaper = least < compared[way] * (isNew ? 1 : SWITCH_BELOW);
    choose(isCheaper ? cheapest : way, isCheaper || compared[way] === least ? 'cheaper' : 'similar', compared);
  };

  /** Begins a window of frames that are watched. */
  const watch = () => {
    watchBegin = null;
    costs[WATCHED] = [];
    intervals[WATCHED] = [];
  };

  /** True if a window ends now whose times differ from those of the first window, or that misses the rate. */
  const hasChanged = (now) => {
    watchBegin ??= now;
    if (now - watchBegin < WATCH) return false;
    const rested = now - begin;
    const times = [costs, intervals].map((all) => middle(all[WATCHED]));
    const isLate = choice.reason === 'holds the rate' && choice.way !== ways.at(-1) && !isPunctual(WATCHED);
    watch();
    if (isLate && rested >= missedRest) {
      missedRest *= 2;
      return true;
    }
    first ??= times;
    return rested >= SHORTEST_REST && times.some((time, i) => time !== null && first[i] !== null && (time > first[i] * DRIFT || time * DRIFT < first[i]));
  };

  const measure = (now) => {
    costs = {};
    intervals = {};
    tags = [];
    phase = MEASURES;
    begin = turnBegin = now;
    turn = count = refresh = 0;
  };

  /** Chooses, once the times of all frames are known or the wait for them is over. */
  const collect = (now) => {
    const isMissing = (way) => !(costs[way]?.length >= intervals[way]?.length);
    if (count-- > 0 && ways.some(isMissing)) return;
    const took = now - begin;
    compare();
    // Pictures that differ are seen.
    let rest = ways.length > 2 || choice.reason === 'both hold the rate' ? LONGEST_REST : LEAST_REST;
    if (choice.costs) {
      const times = Object.values(choice.costs);
      const more = (Math.max(...times) / Math.min(...times) - 1) / 2;
      rest = Math.min(Math.max(took * more / OVERHEAD, rest), LONGEST_REST);
    }
    watch();
    first = null;
    turn = 0;
    phase = RESTS;
    begin = now;
    until = now + rest;
  };

  /** Begins the next turn or phase, if it is time. */
  const proceed = (now) => {
    if (phase === SETTLES) {
      begin ??= now;
      if (now - begin >= SETTLING) measure(now);
    } else if (phase === MEASURES) {
      const n = ways.length;
      if (++count < TURN_FRAMES || now - turnBegin < TURN[Number(n > 2)]) return;
      turnBegin = now;
      count = 0;
      if (++turn < TURNS || turn % n > 0 || now - begin < MEASURING) return;
      // Of pictures that differ, the last one stays until one is chosen.
      turn = n > 2 ? turn - 1 : 0;
      phase = COLLECTS;
      count = LATE_FRAMES;
      collect(now);
    } else if (phase === COLLECTS) {
      collect(now);
    } else if (hasChanged(now) || now >= until) {
      measure(now);
    }
  };

  const chooser = {
    /** The last choice: way, reason and, if they could be compared, the times of all ways. */
    get choice() {
      return choice;
    },

    /** The way to make the next frame. */
    get way() {
      return ways[(ways.indexOf(choice.way) + turn) % ways.length];
    },

    /**
     * Measures again: for another scene, place, resolution or other ways.
     *
     * @param {string[]} [newWays] - From the best one on.
     * @param {boolean} [areRanked] - True if the first one is better than the second one, and not only dearer.
     */
    sceneChanged(newWays = ways, areRanked = isRanked) {
      ways = newWays;
      isRanked = areRanked;
      phase = SETTLES;
      turn = 0;
      missedRest = MISSED_REST;
      begin = last = null;
      choose(ways.includes(choice.way) ? choice.way : ways[1], 'unmeasured');
    },

    /**
     * Counts a frame.
     *
     * @param {number} now - The time.
     * @param {number} rate - The display's refreshes per second, or 0 if unknown.
     * @param {string|null} rendered - How the frame was made, or null if it counts for no way.
     * @param {[number, number]|null} cost - How many frames ago was a frame whose GPU time has become known, and that time.
     */
    endFrame(now, rate, rendered, cost) {
      const interval = last === null ? null : now - last;
      last = now;
      const isPause = interval > PAUSE;
      let tag = null;
      if (!isPause && rendered === chooser.way) {
        if (phase === MEASURES && count >= UNCOUNTED_FRAMES) tag = rendered;
        else if (phase === RESTS) tag = WATCHED;
      }
      tags.push(tag);
      if (tags.length > REMEMBERED) tags.shift();
      if (isPause) {
        if (phase === RESTS) return watch();
        phase = SETTLES;
        turn = 0;
        begin = now;
        return;
      }
      // Without a display's pace, the time between frames says nothing about the cost of those that are watched.
      if (interval !== null && tag !== null && (tag !== WATCHED || rate > 0)) {
        (intervals[tag] ??= []).push(interval);
        refresh = rate;
      }
      const [ago, ms] = cost ?? [];
      const of = tags.at(-1 - ago);
      if (of && ms > 0 && ms < Infinity) (costs[of] ??= []).push(ms);
      proceed(now);
    },
  };
  chooser.sceneChanged();
  return chooser;
}
