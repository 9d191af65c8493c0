#include "runtime/seal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "runtime/checksum.h"

namespace scree {

namespace {

constexpr char kMagic[16] = {'s', 'c', 'r', 'e', 'e', ' ', 'c', 'h', 'e', 'c', 'k', 'p', 'o', 'i', 'n', 't'};
constexpr uint32_t kByteOrder = 0x01020304;
constexpr uint64_t kPiece = 4 << 20;  // B, read at once

struct Header {
  char magic[16];
  uint32_t byte_order, format;
  uint64_t file_size;  // B
  uint64_t gaps;       // checksum of all that is neither header nor extent
  uint64_t extents;    // how many follow
  Extent extent[(kHeaderBytes - 56) / sizeof(Extent)];
  uint64_t own;  // checksum of the header up to here
};
static_assert(sizeof(Header) <= kHeaderBytes && std::is_trivially_copyable_v<Header>);
constexpr size_t kMostExtents = std::size(Header{}.extent);

class File {
 public:
  File(const std::filesystem::path& path, int flags) : descriptor_(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (descriptor_ < 0) throw_errno();
  }
  ~File() { ::close(descriptor_); }
  File(const File&) = delete;

  uint64_t size() const {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0) throw_errno();
    if (S_ISDIR(status.st_mode)) throw std::system_error(EISDIR, std::generic_category());  // has some size, too
    return static_cast<uint64_t>(status.st_size);
  }
  void read(void* data, uint64_t size, uint64_t offset) const {
    for (char* to = static_cast<char*>(data); size > 0;) {
      const ssize_t n = pread(descriptor_, to, size, static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw_errno();
      if (n == 0) throw SealBroken(fmt::format("truncated: it ends at byte {}", offset));
      to += n, size -= n, offset += n;
    }
  }
  void write(const void* data, uint64_t size, uint64_t offset) const {
    for (const char* from = static_cast<const char*>(data); size > 0;) {
      const ssize_t n = pwrite(descriptor_, from, size, static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw_errno();
      from += n, size -= n, offset += n;
    }
  }
  void sync() const {
    if (fsync(descriptor_) != 0) throw_errno();
  }

 private:
  [[noreturn]] static void throw_errno() { throw std::system_error(errno, std::generic_category()); }
  int descriptor_;
};

void add_stretch(const File& file, uint64_t begin, uint64_t end, Checksum& sum) {
  std::vector<char> piece(std::min(kPiece, end - begin));
  for (uint64_t at = begin; at < end; at += piece.size()) {
    const uint64_t size = std::min<uint64_t>(piece.size(), end - at);
    file.read(piece.data(), size, at);
    sum.add(piece.data(), size);
  }
}

// The checksum of what lies between the header, the extents (in ascending order) and the file's end.
uint64_t checksum_of_gaps(const File& file, const Header& h) {
  Checksum sum;
  uint64_t at = kHeaderBytes;
  for (uint64_t k = 0; k < h.extents; ++k) {
    const Extent& e = h.extent[k];
    if (e.offset < at || e.offset > h.file_size || e.size > h.file_size - e.offset)
      throw SealBroken("the header's arrays overlap or leave the file");
    add_stretch(file, at, e.offset, sum);
    at = e.offset + e.size;
  }
  add_stretch(file, at, h.file_size, sum);
  return sum.value();
}

uint64_t checksum_of(const Header& h) {
  Checksum sum;
  sum.add(&h, offsetof(Header, own));
  return sum.value();
}

}  // namespace

void seal(const std::filesystem::path& path, std::vector<Extent> extents) {
  if (extents.size() > kMostExtents) throw std::logic_error("seal: too many large arrays for the header");
  std::ranges::sort(extents, {}, &Extent::offset);
  const File file(path, O_RDWR);
  Header h{};
  std::memcpy(h.magic, kMagic, sizeof kMagic);
  h.byte_order = kByteOrder, h.format = kCheckpointFormat;
  h.file_size = file.size(), h.extents = extents.size();
  std::ranges::copy(extents, h.extent);
  h.gaps = checksum_of_gaps(file, h);
  h.own = checksum_of(h);
  file.write(&h, sizeof h, 0);
  file.sync();
}

void verify_seal(const std::filesystem::path& path) {
  const File file(path, O_RDONLY);
  const uint64_t size = file.size();
  Header h{};
  if (size < kHeaderBytes) throw SealBroken(fmt::format("not a checkpoint: only {} bytes", size));
  file.read(&h, sizeof h, 0);
  if (std::memcmp(h.magic, kMagic, sizeof kMagic) != 0)
    throw SealBroken("not a checkpoint, or one whose writing was cut short: its header is missing");
  if (h.byte_order != kByteOrder) throw SealBroken("written on a machine of another byte order");
  if (h.format != kCheckpointFormat)
    throw SealBroken(
        fmt::format("format {} of another version of scree; this one reads format {}", h.format, kCheckpointFormat));
  if (h.own != checksum_of(h) || h.extents > kMostExtents) throw SealBroken("damaged: its header's checksum is wrong");
  if (size < h.file_size) throw SealBroken(fmt::format("truncated: {} of {} bytes", size, h.file_size));
  if (size > h.file_size) throw SealBroken(fmt::format("damaged: {} bytes, must be {}", size, h.file_size));
  if (checksum_of_gaps(file, h) != h.gaps) throw SealBroken("damaged: the checksum of its structure is wrong");
  for (uint64_t k = 0; k < h.extents; ++k) {
    const Extent& e = h.extent[k];
    Checksum sum;
    add_stretch(file, e.offset, e.offset + e.size, sum);
    if (sum.value() != e.checksum)
      throw SealBroken(
          fmt::format("damaged: a checksum is wrong between bytes {} and {}", e.offset, e.offset + e.size));
  }
}

}  // namespace scree
