// SPDX-License-Identifier: Apache-2.0
// The one rule by which stages remember: one that is asked again with the same inputs does not run again.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

namespace photonloupe {

// All inputs of a stage: numbers and texts written out, and things that stay what they are.
class MemoKey {
public:
    template <class... Values>
    explicit MemoKey(const Values&... values) {
        std::ostringstream text;
        text << std::hexfloat;
        ((text << values << '/'), ...);
        m_text = text.str();
    }
    MemoKey& add(const std::shared_ptr<const void>& thing) {
        m_things.emplace_back(thing);
        return *this;
    }
    bool operator==(const MemoKey& other) const {
        const auto is_same = [](const auto& a, const auto& b) { return !a.owner_before(b) && !b.owner_before(a); };
        return m_text == other.m_text &&
               std::equal(m_things.begin(), m_things.end(), other.m_things.begin(), other.m_things.end(), is_same);
    }

private:
    std::string m_text;
    std::vector<std::weak_ptr<const void>> m_things; // one that is gone is no other's equal
};

// How long a result is remembered: until the next, or only as long as somebody else holds it too.
enum class Lifetime { until_next, while_held };

template <class Result>
class Memo {
public:
    explicit Memo(Lifetime lifetime) : m_lifetime(lifetime) {}

    // What the stage gave when it was asked this last, or nothing.
    std::shared_ptr<const Result> recall(const MemoKey& key) const {
        const std::lock_guard lock(m_mutex);
        return key == m_key ? m_result.lock() : nullptr;
    }
    void remember(MemoKey key, const std::shared_ptr<const Result>& result) {
        const std::lock_guard lock(m_mutex);
        m_key = std::move(key);
        m_result = result;
        m_held = m_lifetime == Lifetime::until_next ? result : nullptr;
    }
    // The same, or what `run` gives now.
    template <class Run>
    std::shared_ptr<const Result> find(MemoKey key, const Run& run) {
        if (std::shared_ptr<const Result> result = recall(key))
            return result;
        auto result = std::make_shared<const Result>(run());
        remember(std::move(key), result);
        return result;
    }
    void forget() { remember(MemoKey(), nullptr); }

private:
    Lifetime m_lifetime;
    mutable std::mutex m_mutex;
    MemoKey m_key;
    std::weak_ptr<const Result> m_result;
    std::shared_ptr<const Result> m_held;
};

} // namespace photonloupe
