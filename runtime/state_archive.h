// Saves and loads values by name. A type says once which of its fields belong to its state:
//
//   template <class Visit>
//   static void for_each_field(const Visit& visit) {
//     visit("stage", &RunState::stage);
//     ...
//   }
//
// Fields may be plain values, strings, vectors of plain values, other such types, and vectors of these. A vector of
// such types is laid out field by field, one array each, so that a checkpoint is few large arrays.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/hdf5_file.h"

namespace scree {

template <class T>
concept HasFields = requires {
  T::for_each_field([](const char*, auto) {});
};

template <class T>
concept PlainValue = std::is_trivially_copyable_v<T> && !HasFields<T>;

class StateWriter {
 public:
  explicit StateWriter(Hdf5Writer& file) : file_(file) {}

  template <class T>
  void array(const std::string& name, std::span<const T> values) {
    file_.begin(name, element_type<T>(), values.size());
    file_.append(values.data(), values.size());
    file_.end();
  }
  template <PlainValue T>
  void save(const std::string& name, const T& value) {
    array(name, std::span(&value, 1));
  }
  void save(const std::string& name, const std::string& value) { array(name, std::span(value)); }
  template <PlainValue T>
  void save(const std::string& name, const std::vector<T>& values) {
    array(name, std::span(values));
  }
  template <HasFields T>
  void save(const std::string& name, const T& value) {
    T::for_each_field([&](const char* field, auto member) { save(name + "/" + field, value.*member); });
  }
  template <HasFields T>
  void save(const std::string& name, const std::vector<T>& values) {
    T::for_each_field([&](const char* field, auto member) { column(name + "/" + field, values, member); });
  }

 private:
  template <class T, PlainValue M>
  void column(const std::string& name, const std::vector<T>& owners, M T::*member) {
    file_.begin(name, element_type<M>(), owners.size());
    for (const T& owner : owners) file_.append(&(owner.*member), 1);
    file_.end();
  }
  template <class T, class M>
  requires requires { typename M::value_type; }
  void column(const std::string& name, const std::vector<T>& owners, M T::*member) {
    std::vector<uint64_t> sizes;
    uint64_t total = 0;
    for (const T& owner : owners) total += sizes.emplace_back((owner.*member).size());
    array(name + "_sizes", std::span<const uint64_t>(sizes));
    file_.begin(name, element_type<typename M::value_type>(), total);
    for (const T& owner : owners) file_.append((owner.*member).data(), (owner.*member).size());
    file_.end();
  }

  Hdf5Writer& file_;
};

// Values of the right names and types that are no state of this case: an index beyond its list, a NaN.
struct StateRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};
inline void require_state(bool good, const char* what) {
  if (!good) throw StateRefused(what);
}

// The same names and types back. Throws Hdf5Error. What the values mean is for their owner to check: StateRefused.
class StateReader {
 public:
  explicit StateReader(ArraySource& file) : file_(file) {}

  bool has(const std::string& name) { return file_.has(name); }
  template <class T>
  uint64_t size(const std::string& name) {
    return file_.begin(name, element_type<T>());
  }
  // Reads an array of which the caller knows the size.
  template <class T>
  void array(const std::string& name, std::span<T> values) {
    if (file_.begin(name, element_type<T>()) != values.size()) throw Hdf5Error(name + ": has another size");
    file_.next(values.data(), values.size());
    file_.end();
  }
  template <PlainValue T>
  void load(const std::string& name, T& value) {
    array(name, std::span(&value, 1));
  }
  void load(const std::string& name, bool& value) {  // a bool that is neither 0 nor 1 must never come to be
    uint8_t byte = 0;
    load(name, byte);
    if (byte > 1) throw Hdf5Error(name + ": neither true nor false");
    value = byte != 0;
  }
  void load(const std::string& name, std::string& value) { list(name, value); }
  template <PlainValue T>
  void load(const std::string& name, std::vector<T>& values) {
    list(name, values);
  }
  template <HasFields T>
  void load(const std::string& name, T& value) {
    T::for_each_field([&](const char* field, auto member) { load(name + "/" + field, value.*member); });
  }
  template <HasFields T>
  void load(const std::string& name, std::vector<T>& values) {
    T::for_each_field([&](const char* field, auto member) { column(name + "/" + field, values, member); });
  }

 private:
  template <class List>
  void list(const std::string& name, List& values) {
    values.resize(file_.begin(name, element_type<typename List::value_type>()));
    file_.next(values.data(), values.size());
    file_.end();
  }
  template <class T, PlainValue M>
  void column(const std::string& name, std::vector<T>& owners, M T::*member) {
    static_assert(!std::is_same_v<M, bool>);
    owners.resize(file_.begin(name, element_type<M>()));
    for (T& owner : owners) file_.next(&(owner.*member), 1);
    file_.end();
  }
  template <class T, class M>
  requires requires { typename M::value_type; }
  void column(const std::string& name, std::vector<T>& owners, M T::*member) {
    std::vector<uint64_t> sizes;
    load(name + "_sizes", sizes);
    owners.resize(sizes.size());
    uint64_t left = file_.begin(name, element_type<typename M::value_type>());
    for (size_t k = 0; k < owners.size(); ++k) {
      if (sizes[k] > left) throw Hdf5Error(name + ": too short");
      left -= sizes[k];
      (owners[k].*member).resize(sizes[k]);
      file_.next((owners[k].*member).data(), sizes[k]);
    }
    file_.end();
  }

  ArraySource& file_;
};

}  // namespace scree
