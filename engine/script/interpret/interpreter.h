// SPDX-License-Identifier: Apache-2.0
// The reference interpreter: the meaning of the language. It runs uniform code, photon loops that cannot run in
// parallel, and, without a device, all of them; generated passes are tested against it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "core/progress.h"
#include "photons/search_space.h"
#include "script/interpret/host_photons.h"
#include "script/interpret/lanes.h"
#include "script/interpret/run_outputs.h"
#include "script/interpret/run_settings.h"
#include "script/plan/plan.h"

namespace photonloupe::script {

inline Number make_number(Type type, double value) {
    return type == Type::integer ? make_integer(static_cast<std::int32_t>(value))
                                 : make_real(static_cast<float>(value));
}
inline Number make_nothing(Type type) {
    return type == Type::integer ? make_integer(0) : make_real(NOT_A_NUMBER);
}

class Interpreter {
public:
    // Runs a parallel loop elsewhere and brings what it reduced into the state. False: the interpreter must run it.
    using RunPass = std::function<bool(const PhotonLoop&, Interpreter&, LoopReport&)>;

    // All must outlive it. Throws Error when a value in `settings` is not exposed or out of its range.
    Interpreter(const Program& program, const Plan& plan, HostPhotons& photons, RunOutputs& outputs,
                const RunSettings& settings, const Progress& progress);

    // The whole script.
    void run(const RunPass& run_pass = {});

    ScriptState& state() { return m_state; }

    // Of an exposed variable, where it was exposed.
    // Where no run came to it, the value it would have had.
    Number exposed_value(std::uint32_t variable) const;

    // Runs the body of a loop that reduces nothing for some photons.
    void iterate_photons(const PhotonLoop& loop, const std::vector<std::uint32_t>& photons, LoopReport& report);

    // Runs a loop's body for one photon, for what it prints only.
    void replay_photon(const PhotonLoop& loop, std::uint32_t photon, std::vector<std::string>& prints);

    // A number of an expression in uniform code (a pass's k and β).
    Number evaluate_uniform(const Expression& expression) { return evaluate(expression); }

private:
    enum class Flow : std::uint8_t { on, leave, next, give };
    struct OutOfFuel { // thrown: ends a photon's iteration, or the script
        Span at;
    };
    struct OutOfTime {}; // thrown: ends a photon's iteration and its loop

    // What one iteration of a photon loop has done and may have to take back.
    struct Iteration {
        const PhotonLoop* loop = nullptr; // null: uniform code
        std::uint32_t photon = NO_PHOTON;
        std::vector<float> parameters; // staged, by dimension - 3
        std::vector<bool> has_parameter;
        float color[3] = {};
        bool has_color = false;
        struct Undo {
            std::uint32_t variable;
            std::size_t element;
            Number before;
            std::uint32_t photon; // of a least or greatest
        };
        std::vector<Undo> undo; // writes to what is reduced
        struct Sample {
            std::size_t histogram; // of RunOutputs
            float value;
        };
        std::vector<Sample> samples;
        std::vector<std::string> prints;
    };

    // One lane's running values in a photon loop, see reductions.h.
    struct Lane {
        std::vector<std::vector<Number>> values;         // by reduced variable
        std::vector<std::vector<std::uint32_t>> photons; // of least and greatest: who gave it
        Moments pca_2d, pca_3d;
    };

    // statements (execute.cpp)
    void expose(std::uint32_t variable);
    Flow execute(const std::vector<Statement>& statements);
    Flow execute(const Statement& statement);
    Flow execute_loop(const Statement& statement);
    void spend_fuel(const Statement& statement);
    void count_step();

    // photon loops (interpret_photon_loop.cpp)
    Flow execute_photon_loop(const Statement& statement);
    Flow interpret_loop(const PhotonLoop& loop, LoopReport& report);
    Flow interpret_in_order(const PhotonLoop& loop, LoopReport& report);
    Flow interpret_as_written(const PhotonLoop& loop, LoopReport& report);
    bool is_over_time() const;
    Flow iterate(const PhotonLoop& loop, std::uint32_t photon, LoopReport& report);
    void take_back();
    void begin_reductions(const PhotonLoop& loop);
    void end_reductions();
    Lane make_lane() const;
    void swap_lane(Lane& lane); // the body works on the lane's own values, until swapped again
    std::vector<std::uint32_t> combine_block(const std::vector<Lane>& lanes) const;
    void commit_iteration();
    void note_exhausted(LoopReport& report, std::uint32_t photon, Span at);
    void check_time(LoopReport& report);

    // expressions (evaluate.cpp)
    Number evaluate(const Expression& expression);
    float evaluate_real(const Expression& expression);
    bool evaluate_truth(const Expression& expression);
    Number evaluate_binary(const Expression& expression);
    Number assign(const Expression& expression);
    Number call_function(const Expression& expression);
    // The place an index names in [0, count), or count and a fault.
    std::size_t find_place(const Expression& index, std::size_t count, Fault outside);
    const std::vector<std::int32_t>& evaluate_list(const Expression& expression);
    std::int32_t convert_to_integer(float value, const Expression& site);
    Number compute(Operator operation, Type type, Number a, Number b, const Expression& site);

    // builtins (interpret_builtins.cpp, interpret_photons.cpp)
    Number call_builtin(const Expression& expression);
    Number call_pure(const Expression& expression);
    Number read_photon(const Expression& expression);
    Number read_path(const Expression& expression);
    Number read_parameter(const Expression& expression);
    Number read_pca(const Expression& expression);
    void change_pca(const Expression& expression);
    void declare_parameter(const Expression& expression);
    std::string name_parameter(std::size_t dimension, const Expression& written, std::string label) const;
    void set_parameter(const Expression& expression);
    void set_color(const Expression& expression);
    void add_to_histogram(const Expression& expression);
    void print(const Expression& expression);
    std::vector<std::int32_t> find_neighbors(const Expression& expression);

    void fault(Fault kind, const Expression& site);

    const Program& m_program;
    const Plan& m_plan;
    HostPhotons& m_photons;
    RunOutputs& m_outputs;
    const RunSettings& m_settings;
    const Progress& m_progress;
    RunPass m_run_pass;
    ScriptState m_state;
    std::map<std::uint32_t, Number> m_exposed;
    Iteration m_iteration;
    std::vector<std::vector<std::uint32_t>> m_function_locals; // variables each function's call begins without
    LaneLayout m_layout;                                       // of the present loop
    std::vector<bool> m_is_reduced;                            // by variable
    std::vector<std::vector<std::uint32_t>> m_choice_photons; // by variable: who gave a least or greatest, in this lane
    std::uint64_t m_fuel = 0;
    std::uint64_t m_steps = 0;                   // turns of loops and photons
    double m_fraction = 0;                       // of the present loop's photons
    const Expression* m_last_declared = nullptr; // the call that left a gap, if there is one at the end
    Number m_given{};                            // what `return` brings
    bool m_has_given = false;
    std::vector<std::int32_t> m_list; // of a list that is used where it is made
    std::chrono::steady_clock::time_point m_loop_start;
    std::uint32_t m_loop_prints = 0;
    bool m_is_replay = false;
    std::vector<std::string> m_replayed;
};

} // namespace photonloupe::script
