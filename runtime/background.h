// Work that goes on beside a run, on one thread: files that are compressed and written while the next steps are taken.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace scree {

// Jobs run one after the other in the order they came. What a job throws comes out of the next submit() or finish(),
// and the jobs behind it are dropped: they may have built on it.
class Background {
 public:
  explicit Background(size_t most_waiting = 1) : most_waiting_(most_waiting), thread_([this] { work(); }) {}
  ~Background();  // finishes; an error is lost
  Background(const Background&) = delete;

  // Returns once no more than `most_waiting` jobs wait, so that what they hold stays bounded. The job begins at once,
  // or after `patience`, but no later than with the next call of any of these.
  void submit(std::function<void()> job, std::chrono::milliseconds patience = {});
  void begin();  // what waits
  // On the calling thread: the next ones that still have patience, unless the other thread is at one.
  void run_patient();
  void finish();  // until no job is left
  bool is_this_thread() const { return std::this_thread::get_id() == thread_.get_id(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    std::function<void()> job;
    Clock::time_point begin_at;  // long ago: now
  };
  void work();
  void run_next(std::unique_lock<std::mutex>& lock);
  void throw_error();

  std::mutex mutex_;
  std::condition_variable changed_;
  size_t most_waiting_;
  std::deque<Waiting> waiting_;
  bool busy_ = false, ending_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace scree
