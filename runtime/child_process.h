// A process that this one has started.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

class ChildProcess {
 public:
  // Starts arguments[0] with the arguments; what it prints is appended to `log`. It is asked to stop if this process
  // ends before it, however that happens. Throws RunError if it cannot be started.
  ChildProcess(const std::vector<std::string>& arguments, const std::filesystem::path& log);
  ChildProcess(ChildProcess&& other) noexcept : pid_(other.pid_), code_(other.code_) { other.pid_ = -1; }
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ~ChildProcess();  // asks it to stop and waits for its end

  std::optional<int> poll();  // its exit code once it has ended; 128 + n if signal n ended it
  void ask_to_stop();         // SIGTERM

 private:
  pid_t pid_;
  std::optional<int> code_;
};

}  // namespace scree
