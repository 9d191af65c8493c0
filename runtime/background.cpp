#include "runtime/background.h"

#include <utility>

namespace scree {

Background::~Background() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true, begin_at_ = {};
  }
  changed_.notify_all();
  thread_.join();
}

void Background::submit(std::function<void()> job, std::chrono::milliseconds patience) {
  begin();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return error_ || waiting_.size() < most_waiting_ || (!busy_ && waiting_.empty()); });
  throw_error();
  if (waiting_.empty()) begin_at_ = std::chrono::steady_clock::now() + patience;
  waiting_.push_back(std::move(job));
  changed_.notify_all();
}

void Background::begin() {
  const std::lock_guard lock(mutex_);
  begin_at_ = {};
  changed_.notify_all();
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
    changed_.wait(lock, [&] { return !waiting_.empty() || ending_; });
    if (waiting_.empty()) return;
    changed_.wait_until(lock, begin_at_, [&] { return begin_at_ <= std::chrono::steady_clock::now(); });
    const std::function<void()> job = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr error;
    try {
      job();
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (error) error_ = error, waiting_.clear();
    changed_.notify_all();
  }
}

}  // namespace scree
