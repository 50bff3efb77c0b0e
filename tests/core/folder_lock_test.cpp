#include "sinew/core/folder_lock.hpp"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sinew/core/error.hpp"

namespace sinew {
namespace {

namespace fs = std::filesystem;

class FolderLockTest : public ::testing::Test {
 protected:
  FolderLockTest() {
    std::string pattern = (fs::temp_directory_path() / "sinew_lock_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~FolderLockTest() override { fs::remove_all(folder_); }

  bool is_free() const {
    try {
      const FolderLock lock(folder_);
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::file_unwritable);
      EXPECT_EQ(error.place().file, folder_.string());
      EXPECT_THAT(error.what(), ::testing::HasSubstr(std::to_string(getpid())));
      return false;
    }
  }

  fs::path folder_;
};

TEST_F(FolderLockTest, ExcludesOthersUntilItIsGone) {
  {
    const FolderLock lock(folder_);
    EXPECT_FALSE(is_free());
    EXPECT_FALSE(is_free()) << "a refused lock must not remove the file of the first";
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_TRUE(is_free());
}

TEST_F(FolderLockTest, AKilledOwnerLocksNothing) {
  const pid_t child = fork();
  if (child == 0) {
    const FolderLock lock(folder_);
    _exit(0);  // without destructors
  }
  waitpid(child, nullptr, 0);
  EXPECT_FALSE(fs::is_empty(folder_)) << "the test needs the file that is left";
  EXPECT_TRUE(is_free());
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FolderLockTest, FoldersThatAreMissingAreNamed) {
  try {
    const FolderLock lock(folder_ / "none");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::file_unwritable);
  }
}

}  // namespace
}  // namespace sinew
