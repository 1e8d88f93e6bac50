// The loop over photons of turning.photon, line 5.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#define FAULT_WORDS 1
#pragma binding readonly uint uniform_words
#pragma binding uint late_bits
#include "script/pass.glsl"
#include "script/numbers.glsl"
#include "script/functions.glsl"
#include "script/axes.glsl"
#include "script/paths.glsl"
#include "script/path_vertices.glsl"
#include "script/parameters.glsl"
#include "script/colors.glsl"

#define ZEROS_float_3 float[3](ZERO, ZERO, ZERO)
float v_gain; precise v_gain;
int v_i;
int v_m;
float v_total; precise v_total;
int v_j;
int v_k;
float v_a[3]; precise v_a;
float v_b[3]; precise v_b;
uvec2 own_path;

void run_body() {
    // 6: m = getNumPathVertices(i);
    v_m = int(own_path.y);
    // 7: if (m < 3) continue;
    if (v_m < 3) {
        return;
    }
    // 8: total = 0;
    v_total = ZERO;
    // 9: for (j = 1; j < m - 1; j++) {
    v_j = 1;
    for (; v_j < v_m - 1 && take_turn(); v_j += 1) {
        // 10: float a[3]; float b[3];
        v_a = ZEROS_float_3;
        v_b = ZEROS_float_3;
        // 11: for (k = 0; k < 3; k++) {
        v_k = 0;
        for (; v_k < 3 && take_turn(); v_k += 1) {
            // 12: a[k] = getPathVertex(i, j, k) - getPathVertex(i, j - 1, k);
            int t1 = find_place(v_k, 3, 0u);
            precise float t2 = pick_axis(read_vertex(own_path, v_j), find_place(v_k, 3, 1u)) - pick_axis(read_vertex(own_path, v_j - 1), find_place(v_k, 3, 2u));
            if (t1 >= 0) v_a[t1] = t2;
            // 13: b[k] = getPathVertex(i, j + 1, k) - getPathVertex(i, j, k);
            int t3 = find_place(v_k, 3, 3u);
            precise float t4 = pick_axis(read_vertex(own_path, v_j + 1), find_place(v_k, 3, 4u)) - pick_axis(read_vertex(own_path, v_j), find_place(v_k, 3, 5u));
            if (t3 >= 0) v_b[t3] = t4;
        }
        share_turns();
        // 15: total += acos(dot(a[0], a[1], a[2], b[0], b[1], b[2]) / (magnitude(a[0], a[1], a[2]) * magnitude(b[0
        v_total += script_acos(script_dot(v_a[0], v_a[1], v_a[2], v_b[0], v_b[1], v_b[2]) / (script_magnitude(v_a[0], v_a[1], v_a[2]) * script_magnitude(v_b[0], v_b[1], v_b[2])));
    }
    share_turns();
    // 17: setPhotonParameter(i, 3, total / (m - 2));
    if (is_inside(3 - 3, int(settings.parameter_count), 6u)) stage_parameter(3, v_total / real(v_m - 2));
    // 18: setPhotonColourEncoding(i, hue(gain * total, 0), hue(gain * total, 1), hue(gain * total, 2));
    staged_color = vec4(script_hue(v_gain * v_total, ZERO), script_hue(v_gain * v_total, 1.0), script_hue(v_gain * v_total, 2.0), 1.0);
}

void run_photon() {
    v_i = photon;
    own_path = find_path(photon);
    start_photon();
    fault_bits[0] = 0u;
    staged_mask = 0u;
    staged_color = vec4(0.0);
    is_committing = !is_dry();
    run_body();
    if (is_photon_complete() && is_committing) {
        write_parameter(3);
        write_color();
    }
    if (has_turns_left() && !is_dry()) {
        count_faults(fault_bits[0], 0u);
    }
}

void main() {
    v_gain = uintBitsToFloat(uniform_words[0u]);
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint block = settings.first_block + group % settings.block_count;
    uint first_round = settings.first_round + group / settings.block_count * settings.rounds;
    uint lane = gl_LocalInvocationID.x;
    for (uint round = first_round; round < min(first_round + settings.rounds, SCRIPT_ROUNDS); ++round) {
        photon = int(block * SCRIPT_BLOCK + round * SCRIPT_LANES + lane);
        if (uint(photon) >= settings.photon_count) break;
        ++turns;
        run_photon();
        share_turns();
        if (!has_turns_left()) {
            atomicOr(late_bits[uint(photon) >> 5u], 1u << (uint(photon) & 31u));
            break;
        }
    }
    report_turns();
}
