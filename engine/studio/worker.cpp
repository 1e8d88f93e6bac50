// SPDX-License-Identifier: Apache-2.0
// Hands jobs to the stages, and what went wrong to the interface.
#include "studio/worker.h"

#include <sstream>

namespace photonloupe::studio {
namespace {

// In one line.
std::string describe_error(const std::exception& error) {
    std::istringstream words(error.what());
    std::string text, word;
    while (words >> word)
        text += (text.empty() ? "" : " ") + word;
    return text;
}

} // namespace

Worker::Worker(Studio& studio, Host host, bool is_threaded)
    : m_studio(studio),
      m_stages(studio.workspace().bench, std::move(host),
               [&studio](std::function<void(Workspace&)> change) { studio.deliver(std::move(change)); }),
      m_is_threaded(is_threaded) {}

bool Worker::take_turn(const Progress& progress) {
    if (m_is_busy)
        return false;
    const std::optional<Job> job = m_studio.take_job();
    if (!job)
        return false;
    ++m_counts[job->kind];
    if (!m_is_threaded) {
        work(*job, progress);
        return true;
    }
    if (m_thread.joinable())
        m_thread.join();
    m_is_busy = true;
    m_thread = std::thread([this, job = *job] {
        work(job, {});
        m_is_busy = false;
    });
    return false;
}

void Worker::close() {
    m_studio.stop_job();
    if (m_thread.joinable())
        m_thread.join();
}

void Worker::work(const Job& job, const Progress& progress) {
    const Progress both{[&](std::string_view stage, double fraction) {
        progress.report(stage, fraction);
        return m_studio.report_progress(std::string(stage), fraction);
    }};
    std::string message;
    try {
        m_stages.run(job, both);
    } catch (const Cancelled&) {
        message = job.kind + ": stopped on request; what was there stays";
    } catch (const std::exception& error) { // whatever it is, the interface says it and goes on
        message = job.kind + ": " + describe_error(error);
    }
    m_studio.end_job(job, message);
}

} // namespace photonloupe::studio
