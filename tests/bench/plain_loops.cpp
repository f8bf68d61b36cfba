// References of speed.py: what this machine does in the same minute.  Usage: plain_loops arithmetic|memory
#include <cstdio>
#include <cstring>
#include <vector>

int main(int argc, char** argv) {
    const bool is_memory = argc == 2 && std::strcmp(argv[1], "memory") == 0;
    double sum = 0.0;
    if (is_memory) {  // 64 MB, beyond the caches, copied 20 times.
        std::vector<double> from(std::size_t{1} << 23, 1.0), to(from.size());
        for (int round = 0; round < 20; ++round) {
            from[static_cast<std::size_t>(round)] = round;
            std::memcpy(to.data(), from.data(), from.size() * sizeof(double));
            sum += to[static_cast<std::size_t>(round)];
        }
    } else {  // Eight chains of a product and a sum.
        double chains[8] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
        for (int round = 0; round < 100'000'000; ++round)
            for (double& x : chains) x = x * 0.999999 + 1e-6;
        for (const double x : chains) sum += x;
    }
    std::printf("%g\n", sum);
}
