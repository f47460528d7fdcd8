#include "thixis/core/comm.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thixis::core {

TEST(Comm, reduces_values_and_arrays_over_all_ranks) {
  const Comm comm;
  const int n = comm.size(), r = comm.rank();
  EXPECT_EQ(comm.sum(r), n * (n - 1) / 2);
  EXPECT_EQ(comm.max(static_cast<long long>(r)), n - 1);
  EXPECT_EQ(comm.min(r + 0.5), 0.5);
  std::vector<double> values{1.0, static_cast<double>(r)};
  comm.sum(values);
  EXPECT_EQ(values, (std::vector<double>{1.0 * n, 0.5 * n * (n - 1)}));
  std::vector<long long> counts{r, -r};
  comm.max(counts);
  EXPECT_EQ(counts, (std::vector<long long>{n - 1, 0}));
  EXPECT_TRUE(comm.any(r == n - 1));
  EXPECT_EQ(comm.all(r == 0), n == 1);
}

TEST(Comm, nan_on_one_rank_is_nan_on_all) {
  const Comm comm;
  const double mine = comm.rank() == comm.size() - 1 ? std::nan("") : 1.0;
  EXPECT_TRUE(std::isnan(comm.max(mine)));
  EXPECT_TRUE(std::isnan(comm.min(mine)));
  std::vector<double> values{mine, 2.0};
  comm.max(values);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[1], 2.0);
}

TEST(Comm, broadcasts_text_and_arrays_of_another_length) {
  const Comm comm;
  std::string text = comm.root() ? "the root's text" : "something else, and longer";
  comm.broadcast(text);
  EXPECT_EQ(text, "the root's text");
  std::vector<int> values = comm.root() ? std::vector<int>{1, 2, 3} : std::vector<int>{};
  comm.broadcast(values);
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3}));
}

TEST(Comm, gathers_arrays_in_the_order_of_the_ranks) {
  const Comm comm;
  const std::vector<long long> mine(comm.rank(), comm.rank());
  std::vector<long long> expected;
  for (int r = 0; r < comm.size(); ++r) expected.insert(expected.end(), r, r);
  EXPECT_EQ(comm.gather(mine), expected);
  EXPECT_EQ(comm.gather_on_root(mine), comm.root() ? expected : std::vector<long long>{});
  EXPECT_EQ(comm.gather(comm.rank() * 0.5).back(), 0.5 * (comm.size() - 1));
  EXPECT_EQ(comm.offset(10), 10 * comm.rank());
}

TEST(Comm, an_error_of_some_ranks_is_thrown_on_all_with_class_and_message_of_the_lowest) {
  const Comm comm;
  const int last = comm.size() - 1;
  std::optional<Error> error;
  if (comm.rank() == last) error = FileError("the disk of the last rank is full");
  try {
    comm.throw_together(error);
    FAIL() << "nothing was thrown";
  } catch (const FileError& caught) {
    EXPECT_EQ(caught.code(), ExitCode::input_output);
    EXPECT_STREQ(caught.what(), "the disk of the last rank is full");
  }
  EXPECT_NO_THROW(comm.throw_together(std::nullopt));
  try {
    comm.together([&] { throw InputError("rank " + std::to_string(comm.rank())); });
    FAIL() << "nothing was thrown";
  } catch (const InputError& caught) {
    EXPECT_STREQ(caught.what(), "rank 0");
  }
}

TEST(Comm, what_the_root_alone_did_arrives_everywhere) {
  const Comm comm;
  EXPECT_EQ(comm.on_root([&] { return 7 + comm.rank(); }), 7);
  EXPECT_EQ(comm.on_root([] { return std::string("text"); }), "text");
  EXPECT_THROW(comm.on_root([]() -> int { throw NotConverged("no"); }), NotConverged);
  int calls = 0;
  comm.on_root([&] { ++calls; });
  EXPECT_EQ(calls, comm.root() ? 1 : 0);
  try {
    comm.on_root([] { throw std::out_of_range("from a library"); });
    FAIL() << "nothing was thrown";
  } catch (const Error& caught) {
    EXPECT_EQ(caught.code(), ExitCode::internal);
  }
}

}  // namespace thixis::core
