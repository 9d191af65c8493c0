// The only file that names the threading runtime. Work is cut into pieces whose number and content do not depend on the
// number of threads, so neither do the results.
#pragma once

#include <omp.h>

#include <cstddef>
#include <exception>

namespace scree {

inline int thread_count() { return omp_get_max_threads(); }
inline void set_thread_count(int threads) { omp_set_num_threads(threads); }
inline int thread_index() { return omp_get_thread_num(); }

// body(k) for k in [0, count), in any order, on all threads. Handed out one by one: a piece takes tens of microseconds
// and a thread that is interrupted must not hold up the rest. What a body throws (no memory is left) is thrown again
// when all threads are done; of several exceptions, any one.
template <class Body>
void parallel_for(size_t count, const Body& body) {
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1)
  for (size_t k = 0; k < count; ++k) {
    try {
      body(k);
    } catch (...) {
#pragma omp critical(scree_parallel_for)
      if (!failure) failure = std::current_exception();
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
