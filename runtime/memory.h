// The memory that a case needs and the memory that there is: what cannot fit is refused before anything is allocated.
#pragma once

#include <filesystem>
#include <string>

#include "runtime/case.h"
#include "runtime/case_error.h"

namespace scree {

struct AvailableMemory {
  double bytes = 0;
  std::string limited_by;  // "free memory of this machine", "the control group's limit", "the limit of `ulimit -v`"
};

// The least of what the kernel calls available, what is left of the control groups' limits (a container's, a batch
// job's) and what is left of RLIMIT_AS. `root` is where /proc and /sys are found, for tests.
AvailableMemory available_memory(const std::filesystem::path& root = "/");

// At the peak of a run, with the lists, sort buffers and search structures, bytes. An estimate, within some 20 %.
double memory_needed(const Case& c);
double memory_of_particles(const Case& c, double count);
double memory_of_primitives(double count);

std::string bytes_text(double bytes);  // "12.3 GB"

// Throws CaseError at `place` with both figures if `bytes` are more than what is available. Costs nothing for few.
void require_memory(const SourcePlace& place, const std::string& what, double bytes);
void require_memory(const Case& c);

// Makes the calling thread's stack as large as a run needs it. A main thread's stack grows when it is used, and where
// it cannot (`ulimit -v`) the process is killed; here std::bad_alloc is thrown.
void take_stack();

}  // namespace scree
