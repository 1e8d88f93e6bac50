// SPDX-License-Identifier: Apache-2.0
// Layers of photons (METHODS §4): a row of axes a photon, the first its layer number (emitter + 1, negative where it has
// no parameters), then its parameters; distances in parameter space, and boxes of it.
// Define ROW_COUNT (vec4s a row takes), EACH_ROW(DO): the calls DO(0) … DO(ROW_COUNT - 1), EACH_PARAMETER(DO): DO(1) …
// DO(parameters), since loops would count against the device's limit, and PERIODIC_PARAMETERS where one wraps.
// Inputs: tree_rows (tree order), tree_ranges (of each node: least, then greatest row), row_periods (0: no wrap).
#pragma binding texel tree_rows
#pragma binding texel tree_ranges
#pragma binding texel row_periods

struct Layer {
    vec4 row[ROW_COUNT];
};

// Rounding of sums of squares in different orders, and of wrapped differences as a share of the period.
const float ROW_ROUNDING = 1.0 - 1e-6;
const float ROW_WRAP_ROUNDING = 4e-7;
// The number of no layer: lanes without a candidate. A query of this number finds those of all that are set.
const float NO_LAYER = 0.0;

float get_number(Layer layer) { return layer.row[0].x; }
bool is_set(Layer layer) { return layer.row[0].x > 0.0; }

Layer load_layer(uint position) {
    Layer layer;
#define LOAD_ROW(r) layer.row[r] = tree_rows_at(ROW_COUNT * position + uint(r));
    EACH_ROW(LOAD_ROW)
    return layer;
}

Layer share_layer(Layer mine, uint lane) {
    Layer layer = mine; // what pads the last row is never read
    layer.row[0].x = broadcast(mine.row[0].x, lane);
#define SHARE_AXIS(a) layer.row[a / 4][a % 4] = broadcast(mine.row[a / 4][a % 4], lane);
    EACH_PARAMETER(SHARE_AXIS)
    return layer;
}

#ifdef PERIODIC_PARAMETERS
vec4 row_period[ROW_COUNT];
vec4 row_inverse[ROW_COUNT];

void load_row_periods() {
#define LOAD_PERIOD(r) row_period[r] = row_periods_at(r); \
    row_inverse[r] = mix(vec4(0.0), 1.0 / max(row_period[r], vec4(1e-37)), greaterThan(row_period[r], vec4(0.0)));
    EACH_ROW(LOAD_PERIOD)
}
#define WRAP_AXIS(a) d = d - row_period[a / 4][a % 4] * roundEven(d * row_inverse[a / 4][a % 4]);
#else
void load_row_periods() {}
#define WRAP_AXIS(a)
#endif

// Squared distance of two photons' parameters, on the raw values.
float measure_parameters(Layer a, Layer b) {
    precise float sum = 0.0;
#define MEASURE_AXIS(i) { precise float d = a.row[i / 4][i % 4] - b.row[i / 4][i % 4]; WRAP_AXIS(i) sum = sum + d * d; }
    EACH_PARAMETER(MEASURE_AXIS)
    return sum;
}

// The least and the greatest of a node's rows.
void load_layer_box(uint node, out Layer least, out Layer most) {
#define LOAD_BOX(r) least.row[r] = tree_ranges_at(2u * ROW_COUNT * node + uint(r)); \
    most.row[r] = tree_ranges_at(2u * ROW_COUNT * node + ROW_COUNT + uint(r));
    EACH_ROW(LOAD_BOX)
}

// Squared distance in parameter space to the photons of a box, a little less for rounding; INFINITY where none has the
// layer number.
float measure_row_gap(Layer from, Layer least, Layer most) {
    float number = get_number(from);
    bool apart = number > most.row[0].x || number < least.row[0].x;
#ifdef IN_PARAMETER_SPACE
    apart = number == NO_LAYER ? most.row[0].x <= 0.0 : apart;
#endif
    float sum = 0.0;
#ifdef PERIODIC_PARAMETERS
#define WRAP_GAP(a) { float p = row_period[a / 4][a % 4]; \
        float before = max(max(q - hi + p, lo - q - p), 0.0), after = max(max(q - hi - p, lo - q + p), 0.0); \
        gap = max(min(gap, min(before, after)) - p * ROW_WRAP_ROUNDING, 0.0); }
#else
#define WRAP_GAP(a)
#endif
#define ADD_GAP(a) { float q = from.row[a / 4][a % 4], lo = least.row[a / 4][a % 4], hi = most.row[a / 4][a % 4]; \
        float gap = max(max(q - hi, lo - q), 0.0); \
        WRAP_GAP(a) \
        sum += gap * gap; }
    EACH_PARAMETER(ADD_GAP)
    return apart ? INFINITY : sum * ROW_ROUNDING;
}

// Whether all photons of a box have the same parameters.
bool is_one_row(Layer least, Layer most) {
    bool is_one = true;
#define TEST_WIDTH(a) is_one = is_one && least.row[a / 4][a % 4] == most.row[a / 4][a % 4];
    EACH_PARAMETER(TEST_WIDTH)
    return is_one;
}

// Beyond this no photon of the tree is from there.
float limit_parameters(Layer from) {
    float sum = 0.0;
#define ADD_SPAN(r) { vec4 span = max(abs(from.row[r] - tree_ranges_at(2u * ROW_COUNT + uint(r))), \
                                      abs(tree_ranges_at(3u * ROW_COUNT + uint(r)) - from.row[r])); \
        if (r == 0) span.x = 0.0; \
        sum += dot(span, span); }
    EACH_ROW(ADD_SPAN)
    return sum * 1.001 + 1e-30;
}

// Whether a row lies within intervals of every axis; one that ends before it begins goes over the seam.
#define IS_BETWEEN(q, lo, hi) ((lo) <= (hi) ? (q) >= (lo) && (q) <= (hi) : (q) >= (lo) || (q) <= (hi))
bool is_between(Layer layer, Layer lo, Layer hi) {
    bool inside = IS_BETWEEN(layer.row[0].x, lo.row[0].x, hi.row[0].x);
#define TEST_AXIS(a) inside = inside && IS_BETWEEN(layer.row[a / 4][a % 4], lo.row[a / 4][a % 4], hi.row[a / 4][a % 4]);
    EACH_PARAMETER(TEST_AXIS)
    return inside;
}

// Whether a box may hold such a row.
bool may_be_between(Layer lo, Layer hi, Layer least, Layer most) {
    bool reached = true;
#define TEST_ROW(r) { bvec4 above = greaterThanEqual(most.row[r], lo.row[r]), below = lessThanEqual(least.row[r], hi.row[r]); \
        bvec4 goes_over = greaterThan(lo.row[r], hi.row[r]); \
        reached = reached && all(bvec4(uvec4(above) & uvec4(below) | uvec4(goes_over) & (uvec4(above) | uvec4(below)))); }
    EACH_ROW(TEST_ROW)
    return reached;
}
