#include "runtime/background.h"

#include <utility>

namespace scree {

Background::~Background() {
  begin();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Background::submit(std::function<void()> job, std::chrono::milliseconds patience) {
  begin();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return error_ || waiting_.size() < most_waiting_ || (!busy_ && waiting_.empty()); });
  throw_error();
  waiting_.push_back({std::move(job), Clock::now() + patience});
  changed_.notify_all();
}

void Background::begin() {
  const std::lock_guard lock(mutex_);
  for (Waiting& w : waiting_) w.begin_at = {};
  changed_.notify_all();
}

void Background::run_patient() {
  std::unique_lock lock(mutex_);
  while (!busy_ && !waiting_.empty() && waiting_.front().begin_at > Clock::now()) run_next(lock);
}

void Background::finish() {
  begin();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.empty() && !busy_; });
  throw_error();
}

void Background::throw_error() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Background::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (ending_ && waiting_.empty()) return;
    if (busy_ || waiting_.empty())
      changed_.wait(lock);
    else if (const Clock::time_point begin_at = waiting_.front().begin_at; begin_at > Clock::now())
      changed_.wait_until(lock, begin_at);
    else
      run_next(lock);
  }
}

void Background::run_next(std::unique_lock<std::mutex>& lock) {
  std::function<void()> job = std::move(waiting_.front().job);
  waiting_.pop_front();
  busy_ = true;
  lock.unlock();
  std::exception_ptr error;
  try {
    job();
  } catch (...) {
    error = std::current_exception();
  }
  job = nullptr;  // what it holds goes before anybody is told that it is done
  lock.lock();
  busy_ = false;
  if (error) error_ = error, waiting_.clear();
  changed_.notify_all();
}

}  // namespace scree
