// How two neighbouring samples of the source relate to a target pixel, which lies at 0. They land at `a` and `b`, in
// pixels; the search meets `a` first, from the near side.

// A surface that is stretched more than this counts as two surfaces with a disocclusion between them.
const float MAX_STRETCH = 2.0;
// A surface ends in a row if the row above or below shows something farther by more pixels of displacement than this.
const float ROW_GAP = 4.0;

// Any view calls these rules; gather writes them out in `is_event` and `meet` (include/segments.glsl).

bool is_torn(float a, float b) {
    return b - a >= MAX_STRETCH;
}

// True if the pixel lies between them: on the visible surface, or in a disocclusion.
bool jumps(float a, float b) {
    return a <= 0.0 && b > 0.0;
}

// True if they are the surface that the pixel shows. Before a disocclusion, the surface extends half a pixel past `a`.
bool is_seen(float a, float b) {
    return jumps(a, b) && (a > -0.5 || !is_torn(a, b));
}

// True if a surface ends at `a`, less than a pixel before the target pixel, and the next sample lies behind it.
bool folds(float a, float b) {
    return a <= 0.0 && max(b, -1.0) < a;
}

// True if a surface ends within a pixel of the target pixel: at `a` if the samples fold, else at `b`, beyond a
// disocclusion.
bool has_rim(float a, float b) {
    return folds(a, b) || (jumps(a, b) && is_torn(a, b) && b < 1.0);
}
