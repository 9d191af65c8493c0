// Named arrays in memory: what a checkpoint holds, to be changed and loaded again.
#pragma once

#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runtime/hdf5_file.h"

namespace scree {

struct StoredArray {
  ElementType type{};
  std::vector<char> bytes;

  uint64_t count() const { return bytes.size() / type.size; }
};
using StoredArrays = std::map<std::string, StoredArray>;

// Refuses what a file would: other names, types and lengths.
class MemorySource final : public ArraySource {
 public:
  explicit MemorySource(const StoredArrays& arrays) : arrays_(arrays) {}
  uint64_t begin(const std::string& name, const ElementType& type) override {
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) throw Hdf5Error(name + ": not there");
    now_ = &found->second, at_ = 0;
    if (now_->type.kind != type.kind || now_->type.size != type.size) throw Hdf5Error(name + ": another type");
    return now_->count();
  }
  bool has(const std::string& name) override {
    const auto first = arrays_.lower_bound(name);
    return first != arrays_.end() && first->first.starts_with(name);
  }
  void next(void* data, uint64_t count) override {
    if (count > now_->count() - at_) throw Hdf5Error("too short");
    if (count > 0) std::memcpy(data, now_->bytes.data() + at_ * now_->type.size, count * now_->type.size);
    at_ += count;
  }
  void end() override {
    if (at_ < now_->count()) throw Hdf5Error("too long");
  }

 private:
  const StoredArrays& arrays_;
  const StoredArray* now_ = nullptr;
  uint64_t at_ = 0;
};

// Passes a file's arrays on, and keeps those that were asked for.
class RecordingSource final : public ArraySource {
 public:
  explicit RecordingSource(const std::filesystem::path& path) : file_(path), memory_(arrays) {}
  bool has(const std::string& name) override { return file_.has(name); }
  uint64_t begin(const std::string& name, const ElementType& type) override {
    const uint64_t count = file_.begin(name, type);
    StoredArray& a = arrays[name];
    a.type = type;
    a.bytes.resize(count * type.size);
    file_.next(a.bytes.data(), count);
    return memory_.begin(name, type);
  }
  void next(void* data, uint64_t count) override { memory_.next(data, count); }
  void end() override { memory_.end(); }

  StoredArrays arrays;

 private:
  Hdf5Reader file_;
  MemorySource memory_;
};

}  // namespace scree
