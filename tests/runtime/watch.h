// What the tests of watches share: a case with a floor and a fibre, what a run said when it stopped, engines with a
// fault put into what they saved.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "kernels/array.h"
#include "runtime/list_check.h"
#include "runtime/results.h"
#include "runtime/state_archive.h"
#include "tests/array_memory.h"
#include "tests/oracle/beds.h"
#include "tests/runtime/case_text.h"

namespace scree {

inline const Bounds kBox{{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}};

inline Case case_with_floor() {
  Case c = ceramic_case(kBox);
  c.gravity = {0, 0, -9.81};
  c.solid.walls = {"floor", "fibre"};
  c.solid.primitives = plane({0, 0, 0}, {0, 0, 1}, kBox, {1, 0});
  const Segment axis{{-0.005, 0, -0.005}, {0.005, 0, -0.005}};
  const Primitives fibre = fibre_network(std::span(&axis, 1), 1e-3, {1, 1});
  c.solid.primitives.insert(c.solid.primitives.end(), fibre.begin(), fibre.end());
  return c;
}

// Steps until it stops; what it said, and where.
inline RunError stopped(Engine& engine, int steps) {
  try {
    for (int k = 0; k < steps; ++k) engine.step();
  } catch (const RunError& error) {
    return error;
  }
  return RunError("did not stop");
}

inline void expect_parts(const RunError& error, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
}

inline void expect_near(const RunError& error, const Vec3& x, double reach) {
  ASSERT_TRUE(error.where.has_value()) << error.what();
  EXPECT_LT(norm(*error.where - x), reach) << error.what();
}

// What `engine` saves, in a fresh engine of the same case; `edit` changes it on the way.
inline std::unique_ptr<Engine> saved_and_loaded(const Engine& engine, const Case& c, const EngineOptions& options = {},
                                                const std::function<void(StoredArrays&)>& edit = {}) {
  const testing::Folder folder;
  const std::string path = folder.path("state.h5");
  {
    Hdf5Writer file(path);
    StateWriter out(file);
    engine.save(out);
    file.close();
  }
  RecordingSource source(path);
  StateReader recorded(source);
  auto loaded = make_engine(c, options);
  loaded->load(recorded);
  if (!edit) return loaded;
  edit(source.arrays);
  MemorySource memory(source.arrays);
  StateReader edited(memory);
  loaded = make_engine(c, options);
  loaded->load(edited);
  return loaded;
}

}  // namespace scree
