// How long a test runs. Those of minutes run shortened under a sanitizer, which makes them some ten times slower: all
// of their code, fewer steps, and of what they claim only what holds of any run. Whole there, too, where the
// environment says SCREE_WHOLE_RUNS=1 (`.ci/sanitize minutes`).
#pragma once

#include <cstdlib>

namespace scree {

inline bool shortened() {
#ifdef SCREE_SANITIZED
  return std::getenv("SCREE_WHOLE_RUNS") == nullptr;
#else
  return false;
#endif
}

// `whole` as the test is meant, `brief` where it is shortened.
template <class T>
T length(T whole, T brief) {
  return shortened() ? brief : whole;
}

}  // namespace scree
