// SPDX-License-Identifier: Apache-2.0
// Whom a query may find, and how far they count as being: the one place that says so. A query is a lane's own: a photon
// of the map (define OWN_PHOTONS: query i stands at tree position i) or a point, with what it brings along.
//
// As a rule the measure is the squared distance in space. FLAT_AXES: all photons and queries lie in one plane and share
// a normal. ON_SURFACE: only those of the same surface, by the radius that takes them in (METHODS §2); ONE_NORMAL: all
// photons share a normal. SAME_LAYER: only those of the query's layer number and, if it is positive, within its reach in
// parameter space (METHODS §4). IN_INTERVALS: only those whose rows lie between two others. IN_PARAMETER_SPACE: the
// measure is the squared distance there, among those of the same layer number. BY_ID: candidates bring their id along,
// nodes the least of their photons'. WITHOUT_SELF: a query does not find the photon that it is.
// HAS_NORMALS: queries bring normals along.
// Inputs: the tree (tree_nodes, tree_positions, tree_normals, normal_boxes; layers.glsl) and, by query, query_points
// (xyz, w id bits of the photon itself), query_normals, query_rows, query_reach (squared), interval_rows (twice ROW_COUNT).
#include "photons/place.glsl"
#include "photons/same_surface.glsl"
#pragma binding texel tree_normals
#pragma binding texel normal_boxes
#pragma binding texel query_points
#pragma binding texel query_normals
#pragma binding texel query_rows
#pragma binding readonly float query_reach
#pragma binding texel interval_rows
#ifdef ROW_COUNT
#include "photons/layers.glsl"
#endif

#if defined(ON_SURFACE) && !defined(ONE_NORMAL)
#define OWN_NORMALS // candidates bring them along
#endif

struct Candidate {
#ifndef IN_PARAMETER_SPACE
    Place place;
#endif
#ifdef OWN_NORMALS
    vec3 normal;
#endif
#ifdef ROW_COUNT
    Layer layer;
#endif
#ifdef BY_ID
    uint id;
#endif
};

// What bounds are measured from, and to: the box about a node's photons.
struct Query {
    Place place;
#ifdef ON_SURFACE
    vec3 steep;
#endif
#ifdef OWN_NORMALS
    vec3 normal;
#endif
#ifdef ROW_COUNT
    Layer layer;
#endif
    float reach2; // squared, in parameter space; of layers
};

struct Node {
#ifndef IN_PARAMETER_SPACE
    Place lo, hi;
#endif
#ifdef OWN_NORMALS
    vec3 normal_lo, normal_hi;
#endif
#ifdef ROW_COUNT
    Layer layer_lo, layer_hi;
#endif
#ifdef BY_ID
    uint least_id;
#endif
};

Place my_place;
vec3 my_normal;
vec3 my_steep; // see photons/same_surface.glsl
float my_flatness;
float my_reach2;
uint my_self;
#ifdef ROW_COUNT
Layer my_layer;
#ifdef IN_INTERVALS
Layer interval_lo;
Layer interval_hi;
#endif
#endif

Candidate load_candidate(uint position, bool valid) {
    Candidate c;
    vec4 photon = tree_positions_at(position);
#ifndef IN_PARAMETER_SPACE
    c.place = valid ? take_place(photon) : FAR_PLACE;
#endif
#ifdef OWN_NORMALS
    c.normal = tree_normals_at(position).xyz;
#endif
#ifdef ROW_COUNT
    c.layer = load_layer(position);
    c.layer.row[0].x = valid ? c.layer.row[0].x : NO_LAYER;
#endif
#ifdef BY_ID
    c.id = floatBitsToUint(photon.w);
#endif
    return c;
}

vec3 share_vector(vec3 mine, uint lane) {
    return vec3(broadcast(mine.x, lane), broadcast(mine.y, lane), broadcast(mine.z, lane));
}

Candidate share_candidate(Candidate mine, uint lane) {
    Candidate c;
#ifndef IN_PARAMETER_SPACE
    c.place = share_place(mine.place, lane);
#endif
#ifdef OWN_NORMALS
    c.normal = share_vector(mine.normal, lane);
#endif
#ifdef ROW_COUNT
    c.layer = share_layer(mine.layer, lane);
#endif
#ifdef BY_ID
    c.id = broadcast(mine.id, lane);
#endif
    return c;
}

#ifndef IN_PARAMETER_SPACE
// From the query to the other.
Place find_offset(Candidate other) { return wrap_offset(other.place - my_place); }

bool may_be_found(Candidate other) {
    bool found = true;
#ifdef OWN_NORMALS
    found = faces_alike(my_normal, other.normal);
#endif
#ifdef PERIODIC
    found = found && other.place.x < FAR_BOUND; // wrapped, a far place may be near
#endif
#ifdef IN_INTERVALS
    found = found && is_between(other.layer, interval_lo, interval_hi);
#elif defined(SAME_LAYER)
    found = found && get_number(other.layer) == get_number(my_layer) &&
            measure_parameters(my_layer, other.layer) <= my_reach2;
#endif
    return found;
}
#endif

bool is_self(Candidate other) {
#ifdef WITHOUT_SELF
    return other.id == my_self;
#else
    return false;
#endif
}

float measure_candidate(Candidate other) {
#ifdef IN_PARAMETER_SPACE
    float measure = measure_parameters(my_layer, other.layer);
    bool found = get_number(my_layer) == NO_LAYER ? is_set(other.layer) : get_number(other.layer) == get_number(my_layer);
    return found && !is_self(other) ? measure : INFINITY;
#else
    Place d = find_offset(other);
#ifdef ON_SURFACE
    float measure = measure_on_surface(d, my_steep);
#else
    float measure = square_length(d);
#endif
    return may_be_found(other) && !is_self(other) ? measure : INFINITY;
#endif
}

// What decides between photons of one measure before their ids do: on surfaces, where the height may be what counts,
// the distance.
uint break_tie(Candidate other) {
#ifdef ON_SURFACE
    return floatBitsToUint(square_length(find_offset(other)));
#else
    return 0u;
#endif
}

Query get_query() {
    Query own;
    own.place = my_place;
#ifdef ON_SURFACE
    own.steep = my_steep;
#endif
#ifdef OWN_NORMALS
    own.normal = my_normal;
#endif
#ifdef ROW_COUNT
    own.layer = my_layer;
#endif
    own.reach2 = my_reach2;
    return own;
}

Query share_query(Query mine, uint lane) {
    Query query = mine;
#ifndef IN_PARAMETER_SPACE
    query.place = share_place(mine.place, lane);
#endif
#ifdef ON_SURFACE
    query.steep = share_vector(mine.steep, lane);
#endif
#ifdef OWN_NORMALS
    query.normal = share_vector(mine.normal, lane);
#endif
#if defined(IN_PARAMETER_SPACE) || defined(SAME_LAYER)
    query.layer = share_layer(mine.layer, lane);
    query.reach2 = broadcast(mine.reach2, lane);
#endif
    return query;
}

Node load_node(uint heap) {
    Node node;
#ifndef IN_PARAMETER_SPACE
    node.lo = take_place(tree_nodes_at(2u * heap));
    node.hi = take_place(tree_nodes_at(2u * heap + 1u));
#endif
#ifdef OWN_NORMALS
    node.normal_lo = normal_boxes_at(2u * heap).xyz;
    node.normal_hi = normal_boxes_at(2u * heap + 1u).xyz;
#endif
#ifdef ROW_COUNT
    load_layer_box(heap, node.layer_lo, node.layer_hi);
#endif
#ifdef BY_ID
    node.least_id = floatBitsToUint(normal_boxes_at(2u * heap).w);
#endif
    return node;
}

// No photon of the node is nearer to the query; INFINITY where none may be found.
float bound_measure(Query from, Node node) {
    float bound = 0.0;
#ifdef IN_PARAMETER_SPACE
    bound = measure_row_gap(from.layer, node.layer_lo, node.layer_hi);
#else
    bound = measure_box_gap(from.place, node.lo, node.hi);
#ifdef ON_SURFACE
#ifndef PERIODIC
    bound = max(bound, bound_height2(from.steep, node.lo - from.place, node.hi - from.place));
#endif
#ifdef OWN_NORMALS
    bound = may_face_alike(from.normal, node.normal_lo, node.normal_hi) ? bound : INFINITY;
#endif
#endif
#ifdef IN_INTERVALS
    bound = may_be_between(interval_lo, interval_hi, node.layer_lo, node.layer_hi) ? bound : INFINITY;
#elif defined(SAME_LAYER)
    bound = measure_row_gap(from.layer, node.layer_lo, node.layer_hi) <= from.reach2 ? bound : INFINITY;
#endif
#endif
    return bound;
}

#ifdef BY_ID
// By what photons are told apart, ascending, as bits: measure, break_tie(), id.
bool is_before(uvec3 a, uvec3 b) {
    return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.z < b.z)));
}

uvec3 share_entry(uvec3 mine, uint lane) {
    return uvec3(broadcast(mine.x, lane), broadcast(mine.y, lane), broadcast(mine.z, lane));
}

// No photon of the node is before this. Where many tie, as in discrete parameters, their ids alone keep nodes away.
uvec3 bound_entry(Query from, Node node) {
    float bound = bound_measure(from, node);
    uint tie = 0u;
#ifdef IN_PARAMETER_SPACE
    bool is_exact = bound < INFINITY && is_one_row(node.layer_lo, node.layer_hi);
    bound = is_exact ? measure_parameters(from.layer, node.layer_lo) : bound;
#elif defined(ON_SURFACE)
    tie = floatBitsToUint(measure_box_gap(from.place, node.lo, node.hi));
#endif
    return uvec3(floatBitsToUint(bound), tie, node.least_id);
}
#endif

// Beyond this no candidate is.
float limit_reach() {
#ifdef IN_PARAMETER_SPACE
    return limit_parameters(my_layer);
#else
    Place lo = take_place(tree_nodes_at(2u)), hi = take_place(tree_nodes_at(3u));
    float far2 = square_length(max(abs(my_place - lo), abs(hi - my_place))) * 1.0001;
#ifdef ON_SURFACE
    return limit_measure(far2, my_flatness);
#else
    return far2;
#endif
#endif
}

// Whether the lane's query, once taken, can find anybody.
bool can_find() {
    bool can = true;
#ifdef ON_SURFACE
    can = my_normal != vec3(0.0);
#ifdef ONE_NORMAL
    can = can && faces_alike(my_normal, normal_boxes_at(2u).xyz);
#endif
#endif
#ifdef IN_PARAMETER_SPACE
    can = get_number(my_layer) >= 0.0; // not unset
#endif
    return can;
}

// Takes query i as the lane's own.
void take_query(uint i, vec4 space_period, float flatness) {
    set_period(space_period);
    vec4 point = query_points_at(i);
    my_place = take_place(point);
    my_self = floatBitsToUint(point.w);
    my_flatness = flatness;
    my_reach2 = 0.0;
#ifdef HAS_NORMALS
    my_normal = query_normals_at(i).xyz;
    my_steep = make_steep(my_normal, flatness);
#endif
#ifdef ROW_COUNT
    load_row_periods();
#define TAKE_ROW(r) my_layer.row[r] = query_rows_at(ROW_COUNT * i + uint(r));
    EACH_ROW(TAKE_ROW)
#ifdef SAME_LAYER
    my_reach2 = query_reach[i];
#endif
#ifdef IN_INTERVALS
#define TAKE_INTERVAL(r) interval_lo.row[r] = interval_rows_at(r); interval_hi.row[r] = interval_rows_at(ROW_COUNT + r);
    EACH_ROW(TAKE_INTERVAL)
#endif
#endif
}
