// SPDX-License-Identifier: Apache-2.0
// Sessions keep every field, name what they refuse, and survive any bytes.
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "fuzz/session_fuzz_entry.h"
#include "studio/session.h"

namespace photonloupe::test {
namespace {

using nlohmann::json;

std::string find_refusal(const std::string& text, const std::filesystem::path& folder = {}) {
    try {
        studio::read_state(text, folder);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

json make_session() {
    return json::parse(studio::write_state({}, {}));
}

// Each leaf gets another value that its field may have.
void change_leaves(json& value) {
    if (value.is_object()) {
        for (auto& [name, inner] : value.items())
            if (name != "version" && name != "format")
                change_leaves(inner);
    } else if (value.is_boolean()) {
        value = !value.get<bool>();
    } else if (value.is_number_float()) {
        value = 1.0;
    }
}

void fuzz(const std::string& text) {
    fuzz_session(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

std::vector<std::string> read_corpus() {
    std::vector<std::string> texts{studio::write_state({}, {})};
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(PHOTONLOUPE_SOURCE_DIR) /
                                                                 "tests/fuzz/corpus/session")) {
        std::ifstream file(entry.path(), std::ios::binary);
        texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return texts;
}

TEST(Session, default_state_is_read_as_written) {
    const std::string text = studio::write_state({}, {});
    EXPECT_EQ(studio::write_state(studio::read_state(text, {}), {}), text);
}

TEST(Session, every_field_is_read_as_written) {
    json session = make_session();
    change_leaves(session);
    session["trace"]["photons"] = 123;
    session["trace"]["emission"] = "random";
    session["script"]["values"] = {{"a", 1.25}};
    session["view"]["mode"] = "voronoi";
    session["loupe"]["pins"] = {7, 3};
    session["parallel"]["axes"] = json::array({json::object()});
    json& axis = session["parallel"]["axes"][0];
    axis = {{"name", "x"},       {"low", -1.0},  {"high", 2.0},
            {"is_closed", true}, {"periods", 3}, {"brushes", {{0.25, 0.5}, {1.0, 2.0}}},
            {"is_flipped", true}};
    session["selection"] = {1, 2, 5};
    session["named"] = {{"few", {4}}};
    EXPECT_EQ(json::parse(studio::write_state(studio::read_state(session.dump(), {}), {})), session);
}

TEST(Session, absent_fields_keep_their_defaults) {
    const studio::StudioState state =
        studio::read_state(R"({"format": "photonloupe session", "version": 1, "loupe": {"k": 7}})", {});
    EXPECT_EQ(state.loupe.k, 7u);
    EXPECT_EQ(state.loupe.space, studio::LoupeState{}.space);
    EXPECT_EQ(state.trace.count, studio::TraceState{}.count);
    EXPECT_EQ(state.selection, nullptr);
}

TEST(Session, paths_below_the_folder_are_relative_and_others_are_not) {
    studio::StudioState state;
    state.trace.scene = "/data/scenes/a.gltf";
    state.image.reference = "/elsewhere/b.exr";
    const json session = json::parse(studio::write_state(state, "/data"));
    EXPECT_EQ(session["trace"]["scene"], "scenes/a.gltf");
    EXPECT_EQ(session["image"]["reference"], "/elsewhere/b.exr");
    const studio::StudioState moved = studio::read_state(session.dump(), "/moved");
    EXPECT_EQ(moved.trace.scene, "/moved/scenes/a.gltf");
    EXPECT_EQ(moved.image.reference, "/elsewhere/b.exr");
}

TEST(Session, relative_path_may_not_leave_the_folder) {
    for (const char* path : {"..", "../a.gltf", "a/../../b.gltf", "./../c"}) {
        json session = make_session();
        session["trace"]["scene"] = path;
        EXPECT_NE(find_refusal(session.dump(), "/data").find("trace.scene must not leave"), std::string::npos) << path;
    }
    json session = make_session();
    session["trace"]["scene"] = "a/../b.gltf";
    EXPECT_EQ(studio::read_state(session.dump(), "/data").trace.scene, "/data/b.gltf");
}

TEST(Session, selection_is_sorted_and_each_id_once) {
    json session = make_session();
    session["selection"] = {5, 1, 5, 3};
    EXPECT_EQ(*studio::read_state(session.dump(), {}).selection, (std::vector<std::uint32_t>{1, 3, 5}));
}

TEST(Session, refusals_name_the_field) {
    const std::pair<const char*, json> wrong[] = {{"/trace/photons", 0},
                                                  {"/trace/photons", 1.5},
                                                  {"/loupe/k", "many"},
                                                  {"/view/mode", "hologram"},
                                                  {"/view/is_split", 1},
                                                  {"/relax/choices/neighbors", 999},
                                                  {"/script/values", {{"a", nullptr}}},
                                                  {"/selection", {-1}},
                                                  {"/named", {{"a", 3}}}};
    for (const auto& [place, value] : wrong) {
        json session = make_session();
        session[json::json_pointer(place)] = value;
        std::string name = std::string(place).substr(1);
        std::replace(name.begin(), name.end(), '/', '.');
        EXPECT_NE(find_refusal(session.dump()).find(name), std::string::npos)
            << place << ": " << find_refusal(session.dump());
    }
}

TEST(Session, first_version_is_read) {
    const studio::StudioState state = studio::read_state(R"({"format": "photonloupe session", "version": 1,
        "trace": {"photons": 7}, "image": {"k": 9, "samples": 2},
        "relax": {"choices": {"steps": 4, "beta": 2, "has_auto_beta": true, "limit": 0, "thresholds": [0, 0]},
                  "used": {"beta": 2, "has_auto_beta": false, "limit": 0.5, "thresholds": [1, 2]}}})",
                                                         {});
    EXPECT_EQ(state.trace.count, 7u);
    EXPECT_EQ(state.image.render.estimate.k, 9u);
    EXPECT_EQ(state.relax.choices.steps, 4u);
    EXPECT_EQ(state.relax.choices.beta, std::nullopt);
    EXPECT_EQ(state.relax.choices.limit, std::nullopt);
    EXPECT_EQ(state.relax.choices.thresholds, std::nullopt);
    EXPECT_EQ(state.relax.used.beta, 2.0);
    EXPECT_EQ(state.relax.used.limit, 0.5);
    EXPECT_EQ(state.relax.used.thresholds, (std::array{1.0, 2.0}));
}

TEST(Session, script_with_any_bytes_is_written_as_text) {
    studio::StudioState state;
    state.script.text = "// \xff\xfe";
    EXPECT_NE(studio::read_state(studio::write_state(state, {}), {}).script.text.find("// "), std::string::npos);
}

TEST(SessionFuzz, corpus_does_no_harm) {
    EXPECT_GE(read_corpus().size(), 4u);
    for (const std::string& text : read_corpus())
        fuzz(text);
}

TEST(SessionFuzz, mutated_sessions_do_no_harm) {
    std::mt19937 engine(1);
    const std::vector<std::string> corpus = read_corpus();
    const char* const pieces[] = {"null", "-1", "1e999", "[]", "{}", "\"\"", "4294967296", "0.5", ":", ",", "\"x\": "};
    for (int round = 0; round < 4000; ++round) {
        std::string text = corpus[engine() % corpus.size()];
        for (std::uint32_t change = 0; change <= engine() % 3; ++change) {
            const std::size_t at = engine() % text.size();
            switch (engine() % 3) {
            case 0:
                text[at] = static_cast<char>(engine());
                break;
            case 1:
                text.replace(at, engine() % 6, pieces[engine() % std::size(pieces)]);
                break;
            default:
                text.erase(at, engine() % 20);
            }
            if (text.empty())
                text = "{}";
        }
        fuzz(text);
    }
}

} // namespace
} // namespace photonloupe::test
