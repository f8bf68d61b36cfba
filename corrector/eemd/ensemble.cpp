#include "corrector/eemd/ensemble.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "corrector/eemd/noise.hpp"

namespace a351::corrector {
namespace {

constexpr int kMembersPerBlock = 8;

EnsembleSums make_sums(std::size_t size) {
    return {std::vector<double>(size), std::vector<double>(size)};
}

void add(EnsembleSums& total, const EnsembleSums& part) noexcept {
    for (std::size_t i = 0; i < total.values.size(); ++i) {
        total.values[i] += part.values[i];
        total.squares[i] += part.squares[i];
    }
}

/// Buffers of one thread.
class BlockWorker {
public:
    explicit BlockWorker(const EnsemblePlan& plan)
        : plan_(plan),
          emd_(plan.signal.size()),
          noisy_(plan.signal.size()),
          components_(plan.signal.size() * (plan.mode_count + 1)),
          sums_(make_sums(components_.size())) {}

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
        const std::size_t n = plan_.signal.size();
        if (plan_.noise_level > 0.0) {
            fill_white_noise(plan_.seed, static_cast<std::uint64_t>(member), noisy_);
            for (std::size_t i = 0; i < n; ++i) {
                noisy_[i] = plan_.signal[i] + plan_.noise_level * noisy_[i];
            }
        } else {
            std::copy(plan_.signal.begin(), plan_.signal.end(), noisy_.begin());
        }
        emd_.decompose(noisy_, plan_.stopping, plan_.finish, components_);
        const std::size_t residue_begin = components_.size() - n;
        for (std::size_t i = 0; i < components_.size(); ++i) {
            const double value = components_[i];
            const double deviation = i < residue_begin ? value : value - plan_.residue_origin;
            sums_.values[i] += value;
            sums_.squares[i] += deviation * deviation;
        }
    }

    const EnsemblePlan& plan_;
    EmdWorkspace emd_;
    std::vector<double> noisy_;
    std::vector<double> components_;
    EnsembleSums sums_;
};

}  // namespace

EnsembleSums sum_ensemble(const EnsemblePlan& plan, int threads) {
    const int blocks = (plan.members + kMembersPerBlock - 1) / kMembersPerBlock;
    std::vector<BlockWorker> workers;
    const int worker_count = std::min(threads, blocks);
    workers.reserve(static_cast<std::size_t>(worker_count));
    for (int i = 0; i < worker_count; ++i) workers.emplace_back(plan);
    EnsembleSums total = make_sums(plan.signal.size() * (plan.mode_count + 1));

    std::atomic<int> next_block = 0;
    std::mutex mutex;
    std::condition_variable committed;
    int commit_block = 0;
    const auto work = [&](BlockWorker& worker) {
        for (int block = next_block++; block < blocks; block = next_block++) {
            const EnsembleSums& sums = worker.sum_block(block);
            std::unique_lock lock(mutex);
            committed.wait(lock, [&] { return commit_block == block; });
            add(total, sums);
            ++commit_block;
            committed.notify_all();
        }
    };
    std::vector<std::jthread> helpers;
    helpers.reserve(workers.size());
    for (std::size_t i = 1; i < workers.size(); ++i) {
        helpers.emplace_back(work, std::ref(workers[i]));
    }
    work(workers.front());
    helpers.clear();
    return total;
}

}  // namespace a351::corrector
