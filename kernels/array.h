// A fixed-capacity array of plain values whose memory is not touched before it is used, so that the threads that fill
// it decide where its pages lie.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace scree {

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  // `stagger`: bytes by which the data starts after a page border. Arrays walked together must not start at equal
  // offsets: their lines would fall on the same cache sets (measured: a factor of 2.9).
  void allocate(size_t capacity, size_t stagger = 0) {
    const size_t bytes = std::max<size_t>(1, (capacity * sizeof(T) + stagger + 4095) / 4096) * 4096;
    memory_.reset(static_cast<char*>(std::aligned_alloc(4096, bytes)));
    if (!memory_) throw std::bad_alloc();
    data_ = reinterpret_cast<T*>(memory_.get() + stagger);
    capacity_ = capacity;
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](size_t k) { return data_[k]; }
  const T& operator[](size_t k) const { return data_[k]; }
  size_t capacity() const { return capacity_; }
  size_t bytes() const { return capacity_ * sizeof(T); }
  void swap(Array& other) {
    memory_.swap(other.memory_), std::swap(data_, other.data_), std::swap(capacity_, other.capacity_);
  }

 private:
  struct Free {
    void operator()(char* p) const { std::free(p); }
  };
  std::unique_ptr<char, Free> memory_;
  T* data_ = nullptr;
  size_t capacity_ = 0;
};

}  // namespace scree
