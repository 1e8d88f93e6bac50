// The loop over photons of order.photon, line 6.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#define FAULT_WORDS 1
#pragma binding readonly uint uniform_words
#pragma binding uint late_bits
#include "script/pass.glsl"
#include "script/numbers.glsl"
#include "script/functions.glsl"
#include "script/parameters.glsl"
#include "script/neighbors.glsl"

int v_i;
ivec2 v_near;
int v_k;
float v_far; precise v_far;
bool v_far_is_set;
int v_x_u;

float f_first_1(float v_a, int v_b) {
    float v_found; precise v_found;
    bool v_found_is_set = false;
    // 2: function first(a, b) { if (a > b) found = a; return found; }
    v_found_is_set = false;
    if (v_a > real(v_b)) {
        v_found = v_a;
        v_found_is_set = true;
    }
    return check_set(v_found_is_set, v_found, 7u);
    return NAN;
}

void f_mark_1(int v_p, float v_amount) {
    // 3: function mark(p, amount) { for (; amount > 1;) amount /= 2; setPhotonParameter(p, 3, amount); }
    while (v_amount > 1.0 && take_step(9u)) {
        v_amount /= 2.0;
    }
    share_turns();
    if (is_inside(3 - 3, int(settings.parameter_count), 10u)) stage_parameter(3, v_amount);
}

void run_body() {
    // 7: near = getKNN(i, 8);
    ivec2 t1 = find_neighbors(0u, v_i, 0u);
    v_near = t1;
    // 8: float far; int x__;
    v_far_is_set = false;
    // 9: k = i % 5;
    v_k = script_remainder(v_i, 5, 1u);
    // 10: x__ = k++ * 10 + k;
    int t2 = v_k;
    v_k = t2 + 1;
    v_x_u = t2 * 10 + v_k;
    // 11: if (x__ > 20 && (k += 2) < 6 || x__ == 3) far = near[k];
    bool t3 = v_x_u > 20;
    if (t3) {
        v_k += 2;
        t3 = v_k < 6;
    }
    if (t3 || v_x_u == 3) {
        v_far = real(read_neighbor(v_near, find_place(v_k, v_near.y, 2u)));
        v_far_is_set = true;
    }
    // 12: while (k-- > 0) { if (k == 2) continue; x__ += near[k % length(near)]; }
    for (;;) {
        int t5 = v_k;
        v_k = t5 - 1;
        if (!(t5 > 0)) break;
        if (!take_step(3u)) break;
        if (v_k == 2) {
            continue;
        }
        v_x_u += read_neighbor(v_near, find_place(script_remainder(v_k, v_near.y, 4u), v_near.y, 5u));
    }
    share_turns();
    // 13: mark(i, first(far, x__) / (i % 3));
    f_mark_1(v_i, f_first_1(check_set(v_far_is_set, v_far, 6u), v_x_u) / real(script_remainder(v_i, 3, 8u)));
}

void run_photon() {
    v_i = photon;
    start_photon();
    fault_bits[0] = 0u;
    staged_mask = 0u;
    is_committing = !is_dry();
    run_body();
    if (is_photon_complete() && is_committing) {
        write_parameter(3);
    }
    if (has_turns_left() && !is_dry()) {
        count_faults(fault_bits[0], 0u);
    }
}

void main() {
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
