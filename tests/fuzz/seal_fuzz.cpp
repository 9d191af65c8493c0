// A checkpoint file with any edit is refused before anything parses it, the untouched file is not.
//
// An input edits a real checkpoint: byte 0 says whether the header's checksum is made right again (so that what lies
// behind that check is reached), byte 1 and 2 by how much the file is cut or lengthened, then for each edit four bytes
// for where, one for how many follow, and these, which are xored with what is there.
#include <fcntl.h>

#include <cstdint>
#include <cstring>
#include <fstream>

#include "runtime/checksum.h"
#include "runtime/seal.h"
#include "tests/fuzz/small_run.h"

namespace scree::fuzz {
namespace {

constexpr size_t kOwnChecksum = 4080, kHeaderEnd = 4088;  // offset and end of Header::own in runtime/seal.cpp
constexpr size_t kMostEdits = 8;

struct World {
  SmallRun run;
  std::string file;
  std::filesystem::path path = run.folder.path() / "edited.h5";
  int descriptor;

  World() {
    std::ifstream in(run.checkpoints[run.checkpoints.size() / 2], std::ios::binary);
    file.assign(std::istreambuf_iterator<char>(in), {});
    descriptor = open(path.c_str(), O_RDWR | O_CREAT, 0600);
    if (with_right_header(file) != file) std::abort();  // the layout is another: mend the constants above
  }
  static std::string with_right_header(std::string bytes) {
    if (bytes.size() < kHeaderEnd) return bytes;
    Checksum sum;
    sum.add(bytes.data(), kOwnChecksum);
    const uint64_t value = sum.value();
    std::memcpy(bytes.data() + kOwnChecksum, &value, sizeof value);
    return bytes;
  }
};

const World& world() {
  static const World w;
  return w;
}

void write(const World& w, const std::string& bytes) {
  if (ftruncate(w.descriptor, 0) != 0 ||
      pwrite(w.descriptor, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    std::abort();
}

std::string edited(std::string bytes, const uint8_t* data, size_t size) {
  size_t at = 0;
  const auto next = [&] { return at < size ? size_t{data[at++]} : 0; };
  const bool right_header = next() & 1;
  const size_t length = next() | next() << 8;
  if (length > 0) bytes.resize(length & 1 ? bytes.size() + length : bytes.size() - std::min(bytes.size(), length * 4));
  for (size_t k = 0; k < kMostEdits && at < size; ++k) {
    const size_t place = next() | next() << 8 | next() << 16 | next() << 24;
    // Half of the places lie in what the header says.
    const size_t begin = place & 1 ? place / 2 % 512 : place / 2 % (bytes.size() + 1);
    for (size_t n = next() % 33, i = 0; i < n; ++i)
      if (const size_t b = next(); begin + i < bytes.size()) bytes[begin + i] ^= static_cast<char>(b);
  }
  return right_header ? World::with_right_header(std::move(bytes)) : bytes;
}

}  // namespace
}  // namespace scree::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace scree;
  const fuzz::World& world = fuzz::world();
  std::string bytes = fuzz::edited(world.file, data, size);
  fuzz::write(world, bytes);
  bool accepted = false;
  try {
    Checkpoints::read(world.path, [&](StateReader&) { accepted = true; });
  } catch (const CheckpointRefused&) {
  }
  // Of a header whose checksum is right, what no field uses may differ; no other byte of the file may.
  const size_t from = size > 0 && (data[0] & 1) ? kHeaderBytes : 0;
  if (bytes.size() >= kHeaderBytes)  // behind the header's last field nothing is meant
    std::copy_n(world.file.begin() + fuzz::kHeaderEnd, kHeaderBytes - fuzz::kHeaderEnd,
                bytes.begin() + fuzz::kHeaderEnd);
  if (bytes == world.file && !accepted) std::abort();
  if (accepted && (bytes.size() != world.file.size() || bytes.compare(from, bytes.npos, world.file, from) != 0))
    std::abort();
  return 0;
}
