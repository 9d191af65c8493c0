// A sealed file tells every kind of damage before anything parses it; arrays come back as they went in.
#include "runtime/seal.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

#include "runtime/checksum.h"
#include "runtime/state_archive.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

using testing::Folder;

struct Part {
  std::vector<double> values;
  std::string name;
  uint32_t number = 0;
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("values", &Part::values), visit("name", &Part::name), visit("number", &Part::number);
  }
  bool operator==(const Part&) const = default;
};

struct Whole {
  bool flag = false;
  double x = 0;
  Part part;
  std::vector<Part> parts;
  std::vector<uint64_t> large;
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("flag", &Whole::flag), visit("x", &Whole::x), visit("part", &Whole::part);
    visit("parts", &Whole::parts), visit("large", &Whole::large);
  }
  bool operator==(const Whole&) const = default;
};

Whole example() {
  Whole w{true, -0.0, {{1, 2, 3}, "one", 7}, {{{}, "", 1}, {{4.5}, "two", 2}, {{5, 6}, "", 3}}, {}};
  w.large.resize(3'000'000);  // more than any buffer on the way
  std::iota(w.large.begin(), w.large.end(), 1);
  return w;
}

void write(const std::string& path, const Whole& w) {
  Hdf5Writer file(path);
  StateWriter(file).save("whole", w);
  seal(path, file.close());
}

std::string reason(const std::string& path) {
  try {
    verify_seal(path);
  } catch (const SealBroken& e) {
    return e.what();
  }
  return "";
}

void flip_bit(const std::string& path, uint64_t byte, int bit) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(byte));
  const char c = static_cast<char>(file.get() ^ (1 << bit));
  file.seekp(static_cast<std::streamoff>(byte));
  file.put(c);
}

TEST(StateArchive, GivesBackWhatWentIn) {
  const Folder folder;
  const std::string path = folder.path("state.h5");
  const Whole in = example();
  write(path, in);
  verify_seal(path);
  Whole out;
  Hdf5Reader file(path);
  StateReader(file).load("whole", out);
  EXPECT_EQ(out, in);
  EXPECT_TRUE(std::signbit(out.x));
}

TEST(StateArchive, RefusesAnotherTypeAndWhatIsNotThere) {
  const Folder folder;
  write(folder.path("state.h5"), example());
  Hdf5Reader file(folder.path("state.h5"));
  StateReader in(file);
  float x;
  EXPECT_THROW(in.load("whole/x", x), Hdf5Error);
  EXPECT_THROW(in.load("whole/y", x), Hdf5Error);
}

TEST(Seal, NoticesAnyFlippedBit) {
  const Folder folder;
  const std::string path = folder.path("state.h5");
  Whole w = example();
  w.large.resize(20000);
  write(path, w);
  const uint64_t size = std::filesystem::file_size(path);
  uint64_t random = 1;
  for (int k = 0; k < 300; ++k) {
    random = random * 6364136223846793005ull + 1442695040888963407ull;
    uint64_t byte = k % 3 == 0 ? (random >> 20) % kHeaderBytes : (random >> 20) % size;
    if (byte >= 4088 && byte < kHeaderBytes) byte = 0;  // behind the header's last field nothing is meant
    const int bit = static_cast<int>(random >> 60) % 8;
    flip_bit(path, byte, bit);
    EXPECT_NE(reason(path), "") << "byte " << byte << ", bit " << bit;
    flip_bit(path, byte, bit);
  }
  EXPECT_EQ(reason(path), "");
}

TEST(Seal, NoticesMissingAndAddedBytes) {
  const Folder folder;
  const std::string path = folder.path("state.h5");
  for (const double share : {0.0, 0.001, 0.3, 0.9999}) {
    write(path, example());
    const auto whole = static_cast<double>(std::filesystem::file_size(path));
    std::filesystem::resize_file(path, static_cast<uint64_t>(share * whole));
    EXPECT_NE(reason(path), "") << share;
  }
  write(path, example());
  std::ofstream(path, std::ios::app) << "x";
  EXPECT_NE(reason(path).find("damaged"), std::string::npos) << reason(path);
}

TEST(Seal, SaysWhatIsNoCheckpointOrOfAnotherVersion) {
  const Folder folder;
  const std::string path = folder.write("text.h5", std::string(10000, 'x'));
  EXPECT_NE(reason(path).find("not a checkpoint"), std::string::npos) << reason(path);
  EXPECT_NE(reason(folder.write("short.h5", "x")).find("not a checkpoint"), std::string::npos);
  { Hdf5Writer unsealed(folder.path("cut.h5")); }
  EXPECT_NE(reason(folder.path("cut.h5")).find("not a checkpoint"), std::string::npos);
  write(path, example());
  flip_bit(path, 20, 1);  // the format's number
  EXPECT_NE(reason(path).find("format"), std::string::npos) << reason(path);
}

TEST(Checksum, DoesNotDependOnHowTheBytesAreCut) {
  std::vector<unsigned char> bytes(1000);
  std::iota(bytes.begin(), bytes.end(), 0);
  Checksum whole;
  whole.add(bytes.data(), bytes.size());
  for (const size_t piece : {1, 7, 32, 33, 999}) {
    Checksum cut;
    for (size_t at = 0; at < bytes.size(); at += piece) cut.add(bytes.data() + at, std::min(piece, bytes.size() - at));
    EXPECT_EQ(cut.value(), whole.value()) << piece;
  }
}

TEST(Checksum, OfNothingChangesNothing) {
  Checksum a, b;
  a.add("abc", 3), b.add("abc", 3);
  b.add(nullptr, 0);
  EXPECT_EQ(a.value(), b.value());
  a.add("def", 3), b.add("def", 3);
  EXPECT_EQ(a.value(), b.value());
}

TEST(Checksum, TellsZerosApartByTheirNumber) {
  const std::vector<char> zeros(64);
  Checksum a, b;
  a.add(zeros.data(), 33), b.add(zeros.data(), 34);
  EXPECT_NE(a.value(), b.value());
}

}  // namespace
}  // namespace scree
