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
        if (!plan_.left.empty()) {
            remove_modes(member);
            return;
        }
        add_noise(member);
        std::size_t k = 0;
        for (; k < plan_.mode_count; ++k) {
            const std::span<const double> mode = emd_.next_mode(plan_.sifting);
            if (mode.empty()) break;
            take(member, k, mode);
        }
        if (plan_.pairs) {
            for (; k < plan_.mode_count; ++k) take_zero(member, k);
        }
        take(member, plan_.mode_count, emd_.residue());
    }

    void remove_modes(int member) noexcept {
        const std::span<double> residue = emd_.residue();
        const std::span<double> left =
            plan_.left.subspan(static_cast<std::size_t>(member) * residue.size(), residue.size());
        if (plan_.continues) {
            std::copy(left.begin(), left.end(), residue.begin());
        } else {
            add_noise(member);
        }
        for (std::size_t k = 0; k < plan_.mode_count; ++k) {
            if (emd_.next_mode(plan_.sifting).empty()) break;
        }
        std::copy(residue.begin(), residue.end(), left.begin());
        take(member, 0, residue);
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

    void take(int member, std::size_t k, std::span<const double> component) noexcept {
        const std::size_t n = sum_length(plan_);
        const std::span<const double> values = component.subspan(plan_.margin, n);
        const double origin = k == plan_.mode_count ? plan_.residue_origin : 0.0;
        double* const sum = sums_.values.data() + k * n;
        if (!plan_.pairs) {
            sums_.squares[k] += plan_.kernels->accumulate(values.data(), n, origin, sum);
            return;
        }
        const std::span<double> pair = std::span(pair_).subspan(k * n, n);
        if (member % 2 == 0) {
            std::copy(values.begin(), values.end(), pair.begin());
        } else {
            for (std::size_t i = 0; i < n; ++i) pair[i] += values[i];
            sums_.squares[k] += plan_.kernels->accumulate(pair.data(), n, 2.0 * origin, sum);
        }
    }

    /// Takes zeroes as mode `k` of a member of a pair that does not have this mode.
    void take_zero(int member, std::size_t k) noexcept {
        const std::size_t n = sum_length(plan_);
        const std::span<double> pair = std::span(pair_).subspan(k * n, n);
        if (member % 2 == 0) {
            std::fill(pair.begin(), pair.end(), 0.0);
        } else {
            sums_.squares[k] +=
                plan_.kernels->accumulate(pair.data(), n, 0.0, sums_.values.data() + k * n);
        }
    }

    const EnsemblePlan& plan_;
    EmdWorkspace emd_;
    std::vector<double> pair_;
    EnsembleSums sums_;
};

}  // namespace

std::optional<EnsembleSums> sum_ensemble(const EnsemblePlan& plan, int threads,
                                         const std::function<bool(int)>& progress) {
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
    struct Stop {
        ~Stop() { next_block = blocks; }
        std::atomic<int>& next_block;
        int blocks;
    };
    int reported = 0;
    bool cancelled = false;
    const auto report = [&](int done) {
        if (!progress || done == reported) return;
        reported = done;
        cancelled = !progress(done);
    };
    {
        std::vector<std::jthread> helpers;
        helpers.reserve(workers.size());
        // Destroyed before the helpers, which therefore end before they are joined.
        const Stop stop{next_block, blocks};
        for (std::size_t i = 1; i < workers.size(); ++i) {
            helpers.emplace_back([&work_on_next, &worker = workers[i]] {
                while (work_on_next(worker)) {
                }
            });
        }
        while (!cancelled && work_on_next(workers.front())) {
            std::unique_lock lock(mutex);
            const int done = std::min(commit_block * kMembersPerBlock, plan.members);
            lock.unlock();
            report(done);
        }
    }
    if (!cancelled) report(plan.members);
    if (cancelled) return std::nullopt;
    return total;
}

}  // namespace a351::corrector::eemd
