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

// The same names and types back. Throws Hdf5Error.
class StateReader {
 public:
  explicit StateReader(Hdf5Reader& file) : file_(file) {}

  bool has(const std::string& name) { return file_.has(name); }

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
    file_.begin(name, element_type<typename M::value_type>());
    for (size_t k = 0; k < owners.size(); ++k) {
      (owners[k].*member).resize(sizes[k]);
      file_.next((owners[k].*member).data(), sizes[k]);
    }
    file_.end();
  }

  Hdf5Reader& file_;
};

}  // namespace scree
