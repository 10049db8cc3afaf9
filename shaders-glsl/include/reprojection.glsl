// Where a pixel of the second eye lies in the dominant eye's image; app/src/eyes.rs, `DisparityLaw`.
uniform vec2 law;        // second column = dominant column + law.x + law.y * depth
uniform int row_offset;  // second row minus dominant row

float dominant_column(int column, float depth) {
    return float(column) - (law.x + law.y * depth);
}

// Column of the dominant pixel that is nearest.
int nearest_column(float column) {
    return int(floor(column + 0.5));
}
