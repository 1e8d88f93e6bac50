// The loop over photons of clusters.photon, line 5.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#define FAULT_WORDS 1
#pragma binding readonly uint uniform_words
#pragma binding uint late_bits
#include "script/pass.glsl"
#include "script/numbers.glsl"
#include "script/functions.glsl"
#include "script/normals.glsl"
#include "script/powers.glsl"
#include "script/lanes.glsl"
#include "script/pca.glsl"
#include "script/pca_lanes.glsl"
#include "script/histograms.glsl"

int v_c;
float v_strongest; precise v_strongest;
uint v_strongest_photon;
int v_who;
float v_flux; precise v_flux;
int v_i;
float v_best; precise v_best;
int v_own;
float v_d; precise v_d;
float v_power; precise v_power;
Moments moments_2d;

void run_body() {
    // 6: best = 1e30; own = 0;
    v_best = 1e+30;
    v_own = 0;
    // 7: for (c = 0; c < 4; c++) {
    v_c = 0;
    for (; v_c < 4 && take_turn(); v_c += 1) {
        // 8: d = magnitude(getPhotonNormal(i, X) - cx[c], getPhotonNormal(i, Y) - cy[c]);
        v_d = script_magnitude(read_normal(v_i).x - (is_inside(v_c, 4, 0u) ? uintBitsToFloat(uniform_words[0u + uint(v_c)]) : NAN), read_normal(v_i).y - (is_inside(v_c, 4, 1u) ? uintBitsToFloat(uniform_words[4u + uint(v_c)]) : NAN));
        // 9: if (d < best) { best = d; own = c; }
        if (v_d < v_best) {
            v_best = v_d;
            v_own = v_c;
        }
    }
    share_turns();
    // 11: sx[own] += getPhotonNormal(i, X); sy[own] += getPhotonNormal(i, Y); count[own]++;
    sum_element(4u, find_place(v_own, 4, 2u), read_normal(v_i).x);
    sum_element(8u, find_place(v_own, 4, 3u), read_normal(v_i).y);
    sum_element(12u, find_place(v_own, 4, 4u), 1);
    // 12: power = getPhotonPower(i, 1);
    v_power = read_power(v_i).y;
    // 13: flux += power;
    v_flux += v_power;
    // 14: if (power > strongest) { strongest = power; who = i; }
    if (v_power > v_strongest) {
        v_strongest = v_power;
        v_strongest_photon = uint(photon);
        v_who = v_i;
    }
    // 15: pushPCA2D(power, best);
    push_point(moments_2d, vec3(v_power, v_best, 0.0));
    // 16: histogram("distance", best, 0, 2, 16);
    script_histogram(8u, v_best, 5u);
}

void run_photon() {
    v_i = photon;
    float old_v_strongest = v_strongest;
    uint old_v_strongest_photon = v_strongest_photon;
    int old_v_who = v_who;
    float old_v_flux = v_flux;
    Moments old_moments_2d = moments_2d;
    start_photon();
    fault_bits[0] = 0u;
    is_committing = !is_dry();
    run_body();
    if (!is_photon_complete()) {
        v_strongest = old_v_strongest;
        v_strongest_photon = old_v_strongest_photon;
        v_who = old_v_who;
        v_flux = old_v_flux;
        moments_2d = old_moments_2d;
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
    lane_base = (block - settings.lane_block) * 30u * SCRIPT_LANES + lane;
    v_strongest = load_real(0u);
    v_strongest_photon = load_word(1u);
    v_who = load_integer(2u);
    v_flux = load_real(3u);
    moments_2d = load_moments(16u);
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
    if (!is_dry()) {
        store(0u, v_strongest);
        store(1u, v_strongest_photon);
        store(2u, v_who);
        store(3u, v_flux);
        store_moments(16u, moments_2d);
    }
    report_turns();
}
