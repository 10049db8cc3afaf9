// What two samples side by side in the source are to a target pixel, which lies at 0. They land at `a` and `b`, in pixels; the
// search meets `a` first, from the near side.

// A surface that is stretched more than this counts as two surfaces with a disocclusion between them.
const float MAX_STRETCH = 2.0;

bool is_torn(float a, float b) {
    return b - a >= MAX_STRETCH;
}

// True if the pixel lies between them: on the surface that it shows, or in a disocclusion.
bool jumps(float a, float b) {
    return a <= 0.0 && b > 0.0;
}

// True if they are the surface that the pixel shows: before a disocclusion, the last half of a pixel.
bool is_seen(float a, float b) {
    return jumps(a, b) && (a > -0.5 || !is_torn(a, b));
}

// True if a surface ends at `a`, less than a pixel before this one, and what follows lies behind it.
bool folds(float a, float b) {
    return a <= 0.0 && max(b, -1.0) < a;
}

// True if a surface ends within a pixel: at `a` if they fold, else at `b`, beyond a disocclusion.
bool has_rim(float a, float b) {
    return folds(a, b) || (jumps(a, b) && is_torn(a, b) && b < 1.0);
}

// The distance in pixels of the samples that fill a hole, whose background lies `away` from it: the edge's pixels must not smear
// into streaks.
float fill_spread(float away) {
    return 0.5 * clamp(abs(away), 1.0, 12.0);
}
