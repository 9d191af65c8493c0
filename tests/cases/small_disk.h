// A small file system that fills up.
#pragma once

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

namespace scree {

// Mounted at a folder as long as it lives.
class SmallDisk {
 public:
  // `size` as mount understands it: "1500k".
  SmallDisk(const std::filesystem::path& folder, const std::string& size) : folder_(folder) {
    std::filesystem::create_directories(folder);
    mounted_ = mount("scree_test", folder.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
    if (!mounted_) why_ = std::strerror(errno);
  }
  ~SmallDisk() {
    if (mounted_) {
      EXPECT_EQ(umount(folder_.c_str()), 0);
    }
  }
  SmallDisk(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  void grow() const { EXPECT_EQ(mount("scree_test", folder_.c_str(), "tmpfs", MS_REMOUNT, "size=500m"), 0); }

  // For a test that may not mount: runs it in a user and mount namespace of its own. Where there is none of that either
  // the test is skipped, but for root, who has no excuse.
  void try_in_a_namespace() const {
    constexpr const char* kInNamespace = "SCREE_TEST_IN_NAMESPACE";
    ASSERT_EQ(getenv(kInNamespace), nullptr) << "no small file system can be mounted in a namespace: " << why_;
    if (std::system("unshare --user --map-root-user --mount true 2>/dev/null") != 0) {
      ASSERT_NE(geteuid(), 0u) << "root cannot mount a small file system: " << why_;
      GTEST_SKIP() << "not tried: a small file system cannot be mounted here: " << why_;
    }
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    const std::string command = std::string(kInNamespace) + "=1 unshare --user --map-root-user --mount '" +
                                std::filesystem::read_symlink("/proc/self/exe").string() +
                                "' --gtest_brief=1 --gtest_filter=" + test.test_suite_name() + "." + test.name();
    EXPECT_EQ(std::system(command.c_str()), 0) << "in a namespace of its own";
  }

 private:
  std::filesystem::path folder_;
  bool mounted_ = false;
  std::string why_;
};

}  // namespace scree
