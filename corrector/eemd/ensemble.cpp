#include "corrector/eemd/ensemble.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace a351::corrector::eemd {
namespace {

constexpr int kMembersPerBlock = 8;  // even, so that a block holds whole pairs

std::size_t sum_length(const EnsemblePlan& plan) { return plan.signal.size() - 2 * plan.margin; }

/// Returns the number of components to sum: the modes and the residue, or only the residue.
std::size_t sum_count(const EnsemblePlan& plan) {
    return plan.left.empty() ? plan.mode_count + 1 : 1;
}

EnsembleSums make_sums(const EnsemblePlan& plan) {
    const std::size_t components = sum_count(plan);
    return {std::vector<double>(sum_length(plan) * components), std::vector<double>(components)};
}

void add(EnsembleSums& total, const EnsembleSums& part) noexcept {
    for (std::size_t i = 0; i < total.values.size(); ++i) total.values[i] += part.values[i];
    for (std::size_t k = 0; k < total.squares.size(); ++k) total.squares[k] += part.squares[k];
}

/// Buffers of one thread.
class BlockWorker {
public:
    explicit BlockWorker(const EnsemblePlan& plan)
        : plan_(plan),
          emd_(plan.signal.size(), *plan.kernels),
          pair_(plan.pairs ? sum_length(plan) * sum_count(plan) : 0),
          sums_(make_sums(plan)) {}

    /// Sums the members of one block, in member order.
    const EnsembleSums& sum_block(int block) noexcept {
        std::fill(sums_.values.begin(), sums_.values.end(), 0.0);
        std::fill(sums_.squares.begin(), sums_.squares.end(), 0.0);
        const int begin = block * kMembersPerBlock;
        const int end = std::min(begin + kMembersPerBlock, plan_.members);
        for (int member = begin; member < end; ++member) add_member(member);
        return sums_;
    }

private:
    void add_member(int member) noexcept {
        if (plan_.pairs && member % 2 == 0) std::fill(pair_.begin(), pair_.end(), 0.0);
        const std::span<double> residue = emd_.residue();
        const bool has_room = !plan_.left.empty();
        const std::span<double> left =
            has_room ? plan_.left.subspan(static_cast<std::size_t>(member) * residue.size(),
                                          residue.size())
                     : std::span<double>();
        if (plan_.continues)
            std::copy(left.begin(), left.end(), residue.begin());
        else
            add_noise(member);
        for (std::size_t k = 0; k < plan_.mode_count; ++k) {
            const std::span<const double> mode = emd_.next_mode(plan_.sifting);
            if (mode.empty()) break;
            if (!has_room) take(k, mode);
        }
        if (has_room) std::copy(residue.begin(), residue.end(), left.begin());
        take(has_room ? 0 : plan_.mode_count, residue);
        if (!plan_.pairs || member % 2 == 0) return;
        for (std::size_t k = 0; k < sums_.squares.size(); ++k)
            add_draw(k, pair_.data() + k * sum_length(plan_));
    }

    void add_noise(int member) noexcept {
        const std::span<double> noisy = emd_.residue();
        if (plan_.noise_level == 0.0) {
            std::copy(plan_.signal.begin(), plan_.signal.end(), noisy.begin());
            return;
        }
        const int draw = plan_.pairs ? member / 2 : member;
        const double level =
            plan_.pairs && member % 2 != 0 ? -plan_.noise_level : plan_.noise_level;
        plan_.kernels->fill_white_noise(plan_.seed, static_cast<std::uint64_t>(draw), noisy.data(),
                                        noisy.size());
        for (std::size_t i = 0; i < noisy.size(); ++i)
            noisy[i] = plan_.signal[i] + level * noisy[i];
    }

    /// Takes component k of a member; the mode of a pair that a member does not have stays 0.
    void take(std::size_t k, std::span<const double> component) noexcept {
        const std::size_t n = sum_length(plan_);
        const double* const values = component.data() + plan_.margin;
        if (!plan_.pairs) {
            add_draw(k, values);
            return;
        }
        double* const pair = pair_.data() + k * n;
        for (std::size_t i = 0; i < n; ++i) pair[i] += values[i];
    }

    /// Adds component k of a member, or of a pair, to the sums.
    void add_draw(std::size_t k, const double* values) noexcept {
        const std::size_t n = sum_length(plan_);
        const double origin = k == plan_.mode_count ? plan_.residue_origin : 0.0;
        sums_.squares[k] += plan_.kernels->accumulate(values, n, (plan_.pairs ? 2.0 : 1.0) * origin,
                                                      sums_.values.data() + k * n);
    }

    const EnsemblePlan& plan_;
    EmdWorkspace emd_;
    std::vector<double> pair_;
    EnsembleSums sums_;
};

}  // namespace

EnsembleSums sum_ensemble(const EnsemblePlan& plan, int threads,
                          const std::function<void(std::size_t, std::size_t)>& progress) {
    const int blocks = (plan.members + kMembersPerBlock - 1) / kMembersPerBlock;
    std::vector<BlockWorker> workers;
    const int worker_count = std::min(threads, blocks);
    workers.reserve(static_cast<std::size_t>(worker_count));
    for (int i = 0; i < worker_count; ++i) workers.emplace_back(plan);
    EnsembleSums total = make_sums(plan);

    std::atomic<int> next_block = 0;
    std::mutex mutex;
    std::condition_variable committed;
    int commit_block = 0;
    // Every block that a thread takes is summed and committed.  So no thread waits for ever.
    const auto work_on_next = [&](BlockWorker& worker) {
        const int block = next_block++;
        if (block >= blocks) return false;
        const EnsembleSums& sums = worker.sum_block(block);
        std::unique_lock lock(mutex);
        committed.wait(lock, [&] { return commit_block == block; });
        add(total, sums);
        ++commit_block;
        committed.notify_all();
        return true;
    };
    int reported = 0;
    const auto report = [&](int done) {
        if (progress && done != reported)
            progress(static_cast<std::size_t>(done), static_cast<std::size_t>(plan.members));
        reported = done;
    };
    {
        std::vector<std::jthread> helpers;
        helpers.reserve(workers.size());
        for (std::size_t i = 1; i < workers.size(); ++i) {
            helpers.emplace_back([&work_on_next, &worker = workers[i]] {
                while (work_on_next(worker)) {
                }
            });
        }
        while (work_on_next(workers.front())) {
            std::unique_lock lock(mutex);
            const int done = std::min(commit_block * kMembersPerBlock, plan.members);
            lock.unlock();
            report(done);
        }
    }
    report(plan.members);
    return total;
}

}  // namespace a351::corrector::eemd
