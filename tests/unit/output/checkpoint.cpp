#include "thixis/output/checkpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "hdf5/hdf5_file.hpp"
#include "scratch.hpp"
#include "seal.hpp"

namespace thixis::output {
namespace {

constexpr GlobalIndex far = 1ll << 40;  ///< ids may lie far apart

/// A value for each id that shows every bit of it.
double value_of(GlobalIndex id) {
  return id == 7 ? -0.0 : id == 13 ? std::numeric_limits<double>::quiet_NaN() : std::sin(1.0 * id) * 1e-200;
}

/// `count` ids 0, 7, 26, ... and one far away, scattered over the ranks in falling order; the last rank has none if there are several.
CheckpointBlock scattered(const std::string& name, int count, const core::Comm& comm) {
  CheckpointBlock block;
  block.name = name;
  const int givers = std::max(1, comm.size() - 1);
  for (GlobalIndex k = count - 1; k >= 0; --k)
    if (k * k % givers == comm.rank()) block.ids.push_back(k + 1 == count ? far : k * (k + 12) / 2);
  for (const GlobalIndex id : block.ids) block.values.push_back(value_of(id));
  return block;
}

Checkpoint example(const core::Comm& comm) {
  Checkpoint checkpoint;
  checkpoint.deck = "<ParameterList name=\"thixis\">\n  ä &amp; \"quotes\"\n</ParameterList>\n";
  checkpoint.folder = "/some where";
  checkpoint.level = 3;
  checkpoint.attributes = {{"time", 0.1}, {"newton steps", 17}, {"largest", std::numeric_limits<double>::infinity()}};
  checkpoint.blocks = {scattered("u1", 100, comm), scattered("lambda", 1, comm), {"nothing", {}, {}}};
  return checkpoint;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Turns one bit in the first place of the file where these bytes stand.
template <class T>
void damage(const std::string& path, T where, const core::Comm& comm) {
  comm.on_root([&] {
    std::string text = content(path);
    const std::size_t at = text.find(std::string(reinterpret_cast<const char*>(&where), sizeof where));
    if (at == std::string::npos) throw core::FileError("These bytes are not in the file.");
    text[at + sizeof where / 2] ^= 0x10;
    std::ofstream(path, std::ios::binary) << text;
  });
}

}  // namespace

TEST(checkpoint, gives_back_deck_attributes_and_level) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_head") + "/checkpoint.h5";
  const Checkpoint saved = example(comm);
  write_checkpoint(path, saved, comm);
  const auto stored = read_checkpoint(path, comm);
  EXPECT_EQ(stored.path(), path);
  EXPECT_EQ(stored.deck(), saved.deck);
  EXPECT_EQ(stored.folder(), saved.folder);
  EXPECT_EQ(stored.level(), 3);
  for (const auto& [name, value] : saved.attributes) EXPECT_EQ(stored.attribute(name), value) << name;
  EXPECT_TRUE(stored.has_attribute("time"));
  EXPECT_FALSE(stored.has_attribute("Time"));
  EXPECT_EQ(stored.size("u1"), 100);
  EXPECT_EQ(stored.size("lambda"), 1);
  EXPECT_EQ(stored.size("nothing"), 0);
  EXPECT_EQ(stored.size("u2"), -1);
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { (void)stored.attribute("step"); }),
            "The checkpoint '" + path + "' does not hold 'step'.");
}

TEST(checkpoint, gives_any_value_to_any_rank_bit_for_bit) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_values") + "/checkpoint.h5";
  write_checkpoint(path, example(comm), comm);
  const auto stored = read_checkpoint(path, comm);
  // ids of all ranks, on the root none, on the others all of them in another order and one twice
  auto ids = comm.gather(scattered("u1", 100, comm).ids);
  std::rotate(ids.begin(), ids.begin() + 29, ids.end());
  ids.push_back(far);
  if (comm.size() > 1 && comm.root()) ids.clear();
  const auto values = stored.fetch("u1", ids);
  ASSERT_EQ(values.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_TRUE(same_bits(values[i], value_of(ids[i]))) << ids[i];
  const auto one = stored.fetch("lambda", {far, far});
  EXPECT_TRUE(same_bits(one[0], value_of(far)) && same_bits(one[1], value_of(far)));
  EXPECT_TRUE(stored.fetch("nothing", {}).empty());
}

TEST(checkpoint, gives_a_list_to_all_ranks) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_list") + "/checkpoint.h5";
  const std::vector<GlobalIndex> list = {7, 3, 3, (GlobalIndex(1) << 53) - 1}, none;
  Checkpoint checkpoint = example(comm);
  checkpoint.blocks.push_back(list_block("some cells", list, comm.root()));
  checkpoint.blocks.push_back(list_block("no cells", none, comm.root()));
  write_checkpoint(path, checkpoint, comm);
  const auto stored = read_checkpoint(path, comm);
  EXPECT_EQ(stored.fetch_list("some cells"), list);
  EXPECT_EQ(stored.fetch_list("no cells"), none);
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { (void)stored.fetch_list("others"); }),
            "The checkpoint '" + path + "' does not hold 'others'.");
}

TEST(checkpoint, does_not_depend_on_who_owns_what) {
  const core::Comm comm;
  const std::string folder = scratch("checkpoint_ranks");
  const Checkpoint saved = example(comm);
  write_checkpoint(folder + "/scattered.h5", saved, comm);
  Checkpoint on_root = saved;
  for (auto& block : on_root.blocks) {
    block.ids = comm.gather_on_root(block.ids);
    block.values = comm.gather_on_root(block.values);
  }
  write_checkpoint(folder + "/root.h5", on_root, comm);
  EXPECT_TRUE(content(folder + "/scattered.h5") == content(folder + "/root.h5"));
}

TEST(checkpoint, is_the_same_file_each_time) {
  // Ranks with equal shares write at once: parts of the file were lost where MPI-IO let them overwrite each other.
  const core::Comm comm;
  const std::string path = scratch("checkpoint_again") + "/checkpoint.h5";
  CheckpointBlock block{"u1", {}, {}};
  for (int k = 0; k < 100; ++k)
    if (k % comm.size() == comm.rank()) {
      block.ids.push_back(k);
      block.values.push_back(k);
    }
  Checkpoint checkpoint;
  checkpoint.deck = std::string(60, 'd');
  checkpoint.folder = "/f";
  checkpoint.attributes = {{"a", 1}, {"b", 2}};
  checkpoint.blocks = {block, {"lambda", block.ids, block.values}, {"nothing", {}, {}}};
  write_checkpoint(path, checkpoint, comm);
  const std::string first = content(path);
  comm.barrier();
  for (int k = 0; k < 60; ++k) {
    write_checkpoint(path, checkpoint, comm);
    EXPECT_TRUE(content(path) == first) << "write " << k;
    comm.barrier();
  }
}

TEST(checkpoint, replaces_an_older_one_as_a_whole_or_not_at_all) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_replaced") + "/checkpoint.h5";
  Checkpoint checkpoint = example(comm);
  write_checkpoint(path, checkpoint, comm);
  checkpoint.level = 4;
  write_checkpoint(path, checkpoint, comm);
  EXPECT_EQ(read_checkpoint(path, comm).level(), 4);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  comm.barrier();
  checkpoint.level = 5;
  {
    const FullDisk full(1000);
    sentence_of(core::ExitCode::input_output, [&] { write_checkpoint(path, checkpoint, comm); });
  }
  comm.barrier();
  EXPECT_EQ(read_checkpoint(path, comm).level(), 4);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(checkpoint, refuses_blocks_that_contradict_themselves) {
  const core::Comm comm;
  const std::string folder = scratch("checkpoint_wrong_blocks");
  const auto sentence = [&](const CheckpointBlock& block) {
    Checkpoint checkpoint;
    checkpoint.blocks = {block};
    return sentence_of(core::ExitCode::internal, [&] { write_checkpoint(folder + "/checkpoint.h5", checkpoint, comm); });
  };
  const bool last = comm.rank() + 1 == comm.size();
  EXPECT_EQ(sentence({"u", {2 * comm.rank(), last ? 0 : 2 * comm.rank() + 1}, {1, 2}}), "The block 'u' has the id 0 twice.");
  EXPECT_EQ(sentence({"u", {last ? -1 : 0}, {1}}), "The block 'u' has the id -1.");
  EXPECT_EQ(sentence({"u", {0}, {}}), "The block 'u' has 1 ids and 0 values.");
  EXPECT_NE(sentence({"u/v", {}, {}}).find("can not be called 'u/v'"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(checkpoint, that_is_none_gets_a_sentence_on_all_ranks) {
  const core::Comm comm;
  const std::string folder = scratch("checkpoint_none");
  const auto sentence = [&](const std::string& path) {
    return sentence_of(core::ExitCode::input_output, [&] { read_checkpoint(path, comm); });
  };
  const std::string advice = "give the checkpoint.h5 in the output directory of a run.";
  EXPECT_EQ(sentence(folder + "/absent.h5"), "There is no checkpoint '" + folder + "/absent.h5'; " + advice);
  EXPECT_EQ(sentence(folder), "'" + folder + "' is a folder; give the checkpoint.h5 in it.");
  const auto no_checkpoint = [&](const std::string& name) {
    return "'" + folder + name + "' is no checkpoint of Thixis, or one of an older version, without a seal; " +
           advice.substr(0, advice.size() - 1) + ", or use the Thixis that wrote it.";
  };
  comm.on_root([&] { std::ofstream(folder + "/deck.xml") << "<ParameterList name=\"thixis\"/>"; });
  EXPECT_EQ(sentence(folder + "/deck.xml"), no_checkpoint("/deck.xml"));
  comm.on_root([&] { std::ofstream(folder + "/empty.h5") << ""; });
  EXPECT_EQ(sentence(folder + "/empty.h5"), no_checkpoint("/empty.h5"));
  Hdf5File(folder + "/fields.h5", Hdf5File::Mode::create, 10000, comm).close();
  EXPECT_EQ(sentence(folder + "/fields.h5"), no_checkpoint("/fields.h5"));
  EXPECT_EQ(sentence("/dev/zero"), "'/dev/zero' is no regular file, but a pipe or a device; " + advice);
  Hdf5File(folder + "/later.h5", Hdf5File::Mode::create, 10000, comm, seal_bytes).close();
  comm.on_root([&] { write_seal(folder + "/later.h5", {"thixis checkpoint", 3}); });
  EXPECT_EQ(sentence(folder + "/later.h5"),
            "The checkpoint '" + folder + "/later.h5' has format 3, this program reads format 2; use the Thixis that wrote it.");
}

TEST(checkpoint, is_damaged_by_every_byte_that_is_another_one) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_bytes") + "/checkpoint.h5";
  write_checkpoint(path, example(comm), comm);
  const std::string whole = content(path), damaged = "The checkpoint '" + path + "' is damaged;";
  comm.barrier();
  const auto refused = [&] {
    return sentence_of(core::ExitCode::input_output, [&] { read_checkpoint(path, comm); }).compare(0, damaged.size(), damaged) == 0;
  };
  const std::size_t stride = comm.size() == 1 ? 3 : 997;
  for (std::size_t at = 0; at < whole.size(); at += at < seal_bytes && comm.size() == 1 ? 1 : stride) {
    const auto put = [&](char byte) {
      comm.on_root([&] {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(at)).put(byte);
      });
    };
    put(static_cast<char>(whole[at] ^ (1 << at % 8)));
    EXPECT_TRUE(refused()) << "byte " << at;
    put(whole[at]);
  }
  EXPECT_EQ(read_checkpoint(path, comm).level(), 3) << "and whole it is whole";
  comm.barrier();
  comm.on_root([&] { std::ofstream(path, std::ios::binary) << whole << '\0'; });
  EXPECT_TRUE(refused()) << "one byte more";
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, seal_bytes + 100, seal_bytes, seal_bytes - 1, std::size_t{100}}) {
    comm.on_root([&] { std::ofstream(path, std::ios::binary) << whole.substr(0, size); });
    EXPECT_TRUE(refused()) << size << " bytes";
  }
}

TEST(checkpoint, does_not_give_numbers_that_no_run_has) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_numbers") + "/checkpoint.h5";
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Checkpoint checkpoint = example(comm);
  checkpoint.attributes = {{"steps", 3}, {"time", 0.1}, {"half", 0.5}, {"below", -1}, {"many", 1e300}, {"nan", nan}, {"inf", inf}};
  checkpoint.blocks = {list_block("halves", {0}, comm.root()), {"u", {}, {}}};
  if (comm.root()) {
    checkpoint.blocks[0].values = {0.5};
    checkpoint.blocks[1] = {"u", {0, 1}, {1, inf}};
  }
  write_checkpoint(path, checkpoint, comm);
  const auto stored = read_checkpoint(path, comm);
  const auto refused = [&](const std::function<void()>& action, const std::string& end) {
    const std::string sentence = sentence_of(core::ExitCode::input_output, action);
    EXPECT_TRUE(sentence.size() > end.size() && sentence.substr(sentence.size() - end.size()) == end) << sentence;
  };
  EXPECT_EQ(stored.count("steps"), 3);
  EXPECT_EQ(stored.number("time", 0), 0.1);
  refused([&] { (void)stored.count("steps", 2); }, " No run has 3 as its 'steps'.");
  refused([&] { (void)stored.count("half"); }, " No run has 0.5 as its 'half'.");
  refused([&] { (void)stored.count("below"); }, " No run has -1 as its 'below'.");
  refused([&] { (void)stored.count("many"); }, " No run has 1e+300 as its 'many'.");
  refused([&] { (void)stored.number("below", 0); }, " No run has -1 as its 'below'.");
  refused([&] { (void)stored.number("nan"); }, " No run has nan as its 'nan'.");
  refused([&] { (void)stored.number("inf"); }, " No run has inf as its 'inf'.");
  refused([&] { (void)stored.fetch_list("halves"); }, " No run has 0.5 as its 'halves'.");
  refused([&] { (void)stored.fetch_finite("u", {0, 1}); }, " No run has inf as its 'u'.");
  EXPECT_EQ(stored.fetch_finite("u", {0}), std::vector<double>{1});
}

TEST(checkpoint, that_is_damaged_is_not_believed) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_damaged") + "/checkpoint.h5";
  const std::string complaint = "The checkpoint '" + path + "' is damaged; go on from another one, or begin anew with 'thixis run'.";
  Checkpoint checkpoint;
  checkpoint.deck = "deck";
  checkpoint.blocks = {{"u", {far + 3 * comm.rank()}, {12345.678}}};
  const auto fetch = [&] { return read_checkpoint(path, comm).fetch("u", {far}); };

  write_checkpoint(path, checkpoint, comm);
  EXPECT_EQ(fetch(), std::vector<double>{12345.678});
  comm.barrier();
  damage(path, 12345.678, comm);
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, fetch), complaint);

  write_checkpoint(path, checkpoint, comm);
  damage(path, far, comm);
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, fetch), complaint);

  write_checkpoint(path, checkpoint, comm);
  comm.on_root([&] { std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2); });
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, fetch), complaint);
}

TEST(checkpoint, says_which_value_it_does_not_hold) {
  const core::Comm comm;
  const std::string path = scratch("checkpoint_missing") + "/checkpoint.h5";
  write_checkpoint(path, example(comm), comm);
  const auto stored = read_checkpoint(path, comm);
  const auto sentence = [&](const std::string& block, const std::vector<GlobalIndex>& ids) {
    return sentence_of(core::ExitCode::input_output, [&] { stored.fetch(block, ids); });
  };
  EXPECT_EQ(sentence("u2", {0}), "The checkpoint '" + path + "' does not hold 'u2'.");
  for (const GlobalIndex absent : {GlobalIndex{1}, far - 1, far + 1})
    EXPECT_EQ(sentence("u1", comm.rank() + 1 == comm.size() ? std::vector<GlobalIndex>{0, absent} : std::vector<GlobalIndex>{}),
              "The checkpoint '" + path + "' has no value of 'u1' with the id " + std::to_string(absent) +
                  ": it belongs to another mesh or method.");
}

}  // namespace thixis::output
