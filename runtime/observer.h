// Something that looks at a run while it goes on and leaves something in the results folder: fields, pictures,
// averages.
//
// A new one is one class in a file of its own, its settings in Case, and a line in runtime/observers.cpp. Observers
// read the engine and change nothing: a run with them ends in the same bits as one without.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <spdlog/logger.h>
#include <nlohmann/json.hpp>

#include "runtime/engine.h"
#include "runtime/schedule.h"
#include "runtime/state_archive.h"

namespace scree {

// What an observer sees. Valid during the call.
struct RunView {
  const Case& c;
  const Engine& engine;
  const Solid& solid;  // what is left of the case's after walls were opened
  const std::string& stage;
  double stage_start;  // s
  const std::filesystem::path& out;
  spdlog::logger& log;
};

class Observer {
 public:
  virtual ~Observer() = default;

  virtual std::string name() const = 0;  // its key in summary.json and its group in a checkpoint
  virtual const Schedule& schedule() const = 0;

  // At the due steps, right after the step: lists, contacts and forces are those of now. Throws RunError (a full disk,
  // a folder that cannot be written): the run stops with a checkpoint.
  virtual void look(const RunView& run) = 0;
  // Once, whatever the end of the run.
  virtual void finish(const RunView&) {}

  // Its state, under names that begin with `at`. What it has written into files by then must be on the disk, too.
  virtual void save(StateWriter&, const std::string& /*at*/) const {}
  virtual void load(StateReader&, const std::string& /*at*/) {}

  virtual nlohmann::json summary() const { return nullptr; }
};

// The observers that the case asks for.
std::vector<std::unique_ptr<Observer>> make_observers(const Case& c, const std::filesystem::path& out, double dt);

}  // namespace scree
