// Preloaded into a process (LD_PRELOAD), makes its wall clock jump: each reading is ten years off the last, back and
// forth. The clock that only ever goes on (CLOCK_MONOTONIC) is left alone. The kernel is asked, not libc: to look up
// libc's own function takes locks, which AddressSanitizer may hold when it reads the clock (seen: it waits for ever).
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <ctime>

namespace {

constexpr time_t kTenYears = 10 * 365 * 86400;

time_t jump() {
  static std::atomic<unsigned> readings{0};
  return readings++ % 2 == 0 ? -kTenYears : kTenYears;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const long result = syscall(SYS_clock_gettime, clock, time);
  if (clock == CLOCK_REALTIME) time->tv_sec += jump();
  return static_cast<int>(result);
}

extern "C" int gettimeofday(timeval* __restrict now, void* __restrict) noexcept {
  timespec time{};
  const int result = clock_gettime(CLOCK_REALTIME, &time);
  *now = {time.tv_sec, time.tv_nsec / 1000};
  return result;
}

extern "C" time_t time(time_t* result) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (result) *result = now.tv_sec;
  return now.tv_sec;
}
