// Shows that the thread sanitizer sees the threads of kernels/parallel.h:
//   seeded_race race     two pieces of a loop write one place: must be reported
//   seeded_race clean    each piece writes its own, read after the loop: must not be
#include <chrono>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <thread>
#include <vector>

#include "kernels/parallel.h"

int main(int argc, char** argv) {
  const bool race = argc > 1 && std::strcmp(argv[1], "race") == 0;
  scree::set_thread_count(4);
  constexpr size_t kPieces = 64;
  std::vector<double> sums(kPieces);
  for (int repeat = 0; repeat < 20; ++repeat)
    scree::parallel_for(kPieces, [&](size_t k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // or one thread does it all on a busy machine
      double& sum = sums[race ? 0 : k];
      for (int n = 0; n < 1000; ++n) sum += 0.5 * n;
    });
  std::printf("%g\n", std::accumulate(sums.begin(), sums.end(), 0.0));
}
