// The only file that names the threading runtime. Work is cut into pieces whose number and content do not depend on the
// number of threads, so neither do the results.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>

namespace scree {

inline int thread_count() { return omp_get_max_threads(); }
inline void set_thread_count(int threads) { omp_set_num_threads(threads); }
inline int thread_index() { return omp_get_thread_num(); }

// A part of a loop. On a cache line of its own: threads look at another's only when theirs is done.
struct alignas(64) LoopShare {
  std::atomic<size_t> next;
  size_t end;
};

// body(k) for k in [0, count), in any order, on all threads. A thread begins with the same share in every loop of that
// length, so that it finds its part of the arrays in its own cache and memory; then it takes pieces of the others': a
// thread that is interrupted must not hold up the rest. What a body throws (no memory is left) is thrown again when all
// threads are done; of several exceptions, any one.
template <class Body>
void parallel_for(size_t count, const Body& body) {
  constexpr size_t kMostShares = 256;
  LoopShare shares[kMostShares];
  const size_t parts = std::min<size_t>(static_cast<size_t>(omp_get_max_threads()), kMostShares);
  for (size_t p = 0; p < parts; ++p) shares[p].next = count * p / parts, shares[p].end = count * (p + 1) / parts;
  std::exception_ptr failure;
#pragma omp parallel
  for (size_t p = 0; p < parts; ++p) {
    LoopShare& share = shares[(static_cast<size_t>(omp_get_thread_num()) + p) % parts];
    while (share.next.load(std::memory_order_relaxed) < share.end) {
      const size_t k = share.next.fetch_add(1, std::memory_order_relaxed);
      if (k >= share.end) break;
      try {
        body(k);
      } catch (...) {
#pragma omp critical(scree_parallel_for)
        if (!failure) failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

// body(k) for each k in [0, count), in pieces.
template <class Body>
void parallel_for_each(size_t count, const Body& body) {
  constexpr size_t piece = 2048;
  parallel_for((count + piece - 1) / piece, [&](size_t c) {
    for (size_t k = c * piece; k < count && k < (c + 1) * piece; ++k) body(k);
  });
}

}  // namespace scree
