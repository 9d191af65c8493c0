// Builds for a fuzzer (SCREE_FUZZ) do less of what is slow and would show a fuzzer nothing new. Clang's own macro says
// so, and only the size of fixed work depends on it, never what is accepted or refused for its form.
#pragma once

namespace scree {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr bool kFuzzing = true;
#else
inline constexpr bool kFuzzing = false;
#endif

}  // namespace scree
