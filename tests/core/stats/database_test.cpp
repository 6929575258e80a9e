#include "sim/stats/database.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sim/base/error.h"

namespace dendro::stats {
namespace {

constexpr std::int32_t kMark = 4711;
constexpr const char* kTable = "CREATE TABLE t(name TEXT, value REAL);";

class DatabaseTest : public ::testing::Test {
 protected:
  DatabaseTest()
      : path_(std::string(::testing::TempDir()) + "/" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".sqlite") {
    std::filesystem::remove(path_);
  }
  ~DatabaseTest() override { std::filesystem::remove(path_); }

  std::string error_of(std::int32_t mark, int version) const {
    try {
      Database database(path_, mark, version, kTable);
    } catch (const UserError& error) {
      return error.message();
    }
    return "no error";
  }

  std::string path_;
};

TEST_F(DatabaseTest, WhatIsCommittedIsThereAfterwards) {
  {
    Database database(path_, kMark, 1, kTable);
    Statement insert(database, "INSERT INTO t VALUES(?, ?)");
    insert.bind("a").bind(0.5).run();
    insert.bind("b").bind_null().run();
  }
  Database database(path_, kMark, 1, kTable);
  Statement all(database, "SELECT name, value FROM t ORDER BY name");
  ASSERT_TRUE(all.step());
  EXPECT_EQ("a", all.text(0));
  EXPECT_EQ(0.5, all.real(1));
  ASSERT_TRUE(all.step());
  EXPECT_EQ("b", all.text(0));
  EXPECT_FALSE(all.real(1).has_value());
  EXPECT_FALSE(all.step());
}

TEST_F(DatabaseTest, ATransactionWithoutCommitLeavesNothing) {
  Database database(path_, kMark, 1, kTable);
  {
    Transaction transaction(database);
    Statement(database, "INSERT INTO t VALUES('a', 1)").run();
  }
  EXPECT_FALSE(Statement(database, "SELECT 1 FROM t").step());
}

TEST_F(DatabaseTest, AnotherVersionIsRefusedAndStaysAsItIs) {
  { Database database(path_, kMark, 1, kTable); }
  EXPECT_NE(std::string::npos, error_of(kMark, 2).find("of version 1, this dendro reads and writes version 2"));
  EXPECT_NE(std::string::npos, error_of(kMark + 1, 1).find("was not made by this command"));
  EXPECT_EQ("no error", error_of(kMark, 1));
}

TEST_F(DatabaseTest, ASecondWriterIsRefused) {
  Database database(path_, kMark, 1, kTable);
  EXPECT_NE(std::string::npos, error_of(kMark, 1).find("locked"));
}

TEST_F(DatabaseTest, AnotherKindOfFileIsRefused) {
  std::ofstream(path_) << std::string(5000, 'x');
  EXPECT_NE(std::string::npos, error_of(kMark, 1).find("no SQLite database"));
}

TEST_F(DatabaseTest, AMissingFolderIsAUserError) {
  path_ = std::string(::testing::TempDir()) + "/there/is/none.sqlite";
  EXPECT_NE(std::string::npos, error_of(kMark, 1).find("cannot write here"));
}

TEST_F(DatabaseTest, AFullDatabaseIsAUserErrorAndKeepsWhatItHas) {
  Database database(path_, kMark, 1, kTable);
  Statement(database, "INSERT INTO t VALUES('first', 1)").run();
  database.execute("PRAGMA max_page_count = 3");
  EXPECT_THROW(Statement(database, "INSERT INTO t VALUES(?, 1)").bind(std::string(100000, 'x')).run(), UserError);
  Statement all(database, "SELECT name FROM t");
  ASSERT_TRUE(all.step());
  EXPECT_EQ("first", all.text(0));
  EXPECT_FALSE(all.step());
}

}  // namespace
}  // namespace dendro::stats
