#include "thixis/output/directory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "scratch.hpp"

namespace thixis::output {
namespace {

std::string refused(const std::string& path) {
  return sentence_of(core::ExitCode::input_output, [&] { RunDirectory(path).create(core::Comm()); });
}

std::string refusal(const std::string& path, const std::string& reason) {
  return "The output directory '" + path + "' can not be used: " + reason +
         ". Name another one by output/directory in the deck or by --output.";
}

}  // namespace

TEST(directory, comes_into_being_with_its_parents_only_when_asked) {
  const core::Comm comm;
  const std::string folder = scratch("directory");
  RunDirectory directory(folder + "/a/b");
  EXPECT_EQ(directory.path(), folder + "/a/b");
  EXPECT_EQ(directory.summary(), folder + "/a/b/summary.json");
  EXPECT_EQ(directory.file("x.vtk"), folder + "/a/b/x.vtk");
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  comm.barrier();
  directory.create(comm);
  EXPECT_TRUE(std::filesystem::is_directory(folder + "/a/b"));
  comm.barrier();
  directory.write_deck("<ParameterList/>\n", comm);
  directory.create(comm);
  EXPECT_EQ(content(directory.deck()), "<ParameterList/>\n");
}

TEST(directory, that_can_not_be_made_is_an_error_on_all_ranks) {
  const core::Comm comm;
  const std::string folder = scratch("directory_errors"), file = folder + "/file";
  if (comm.root()) std::ofstream(file) << "x";
  comm.barrier();
  EXPECT_EQ(refused(file), refusal(file, "'" + file + "' is a file"));
  EXPECT_EQ(refused(file + "/a/b"), refusal(file + "/a/b", "'" + file + "' is a file"));
  EXPECT_EQ(refused(""), refusal("", "its name is empty"));
  EXPECT_EQ(refused("/proc/none/a"), refusal("/proc/none/a", "No such file or directory"));
}

TEST(directory, is_of_one_run_at_a_time) {
  const core::Comm comm;
  const std::string folder = scratch("directory_locked");
  const std::string taken = "Another run writes to the folder '" + folder + "' now; ";
  {
    RunDirectory first(folder);
    first.create(comm);
    first.create(comm);
    EXPECT_EQ(refused(folder).substr(0, taken.size()), taken);
    RunDirectory(folder + "/inside").create(comm);
  }
  comm.barrier();
  EXPECT_NO_THROW(RunDirectory(folder).create(comm));
  EXPECT_FALSE(std::filesystem::exists(folder + "/.lock")) << "nothing is left";
}

TEST(directory, may_be_a_link_and_holds_none_that_would_be_written_through) {
  const core::Comm comm;
  const std::string folder = scratch("directory_links");
  comm.on_root([&] {
    std::filesystem::create_directory(folder + "/there");
    std::filesystem::create_directory_symlink("there", folder + "/here");
  });
  EXPECT_NO_THROW(RunDirectory(folder + "/here").create(comm));
  for (const char* name : {"log.txt", "summary.json", "history.csv", "checkpoint.h5", "checkpoint.h5.part", "fields.h5", "fields"}) {
    const std::string link = folder + "/there/" + name;
    comm.on_root([&] { std::filesystem::create_symlink("/nowhere/at/all", link); });
    const std::string sentence = refused(folder + "/here");
    EXPECT_NE(sentence.find(std::string("/") + name + "' can not be written: there is a link of this name"), std::string::npos) << sentence;
    comm.on_root([&] { std::filesystem::remove(link); });
  }
  EXPECT_NO_THROW(RunDirectory(folder + "/here").create(comm));
}

TEST(directory, that_is_protected_is_an_error_on_all_ranks) {
  if (::geteuid() == 0) GTEST_SKIP() << "nothing is protected from the superuser";
  const core::Comm comm;
  const std::string folder = scratch("directory_protected");
  comm.on_root([&] { std::filesystem::permissions(folder, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec); });
  EXPECT_EQ(refused(folder), refusal(folder, "Permission denied"));
  EXPECT_EQ(refused(folder + "/a"), refusal(folder + "/a", "Permission denied"));
  comm.on_root([&] { std::filesystem::permissions(folder, std::filesystem::perms::owner_all); });
}

TEST(directory, without_a_place_for_the_deck_is_an_error_on_all_ranks) {
  const std::string folder = scratch("deck_errors");
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { RunDirectory(folder + "/none").write_deck("", core::Comm()); }),
            "The file '" + folder + "/none/deck.xml' can not be written: No such file or directory.");
}

}  // namespace thixis::output
