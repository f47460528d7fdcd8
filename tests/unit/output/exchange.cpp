#include "hdf5/exchange.hpp"

#include <gtest/gtest.h>

namespace thixis::output {

TEST(exchange, brings_answers_back_to_the_items_that_asked) {
  const core::Comm comm;
  // item i of each rank goes to rank (i + rank) mod (size + 1), to nobody where there is none
  std::vector<int> target;
  std::vector<GlobalIndex> question;
  for (int i = 0; i < 10 * comm.rank() + 5; ++i) {
    const int rank = (i + comm.rank()) % (comm.size() + 1);
    target.push_back(rank == comm.size() ? -1 : rank);
    question.push_back(1000 * comm.rank() + i);
    question.push_back(i);
  }
  const Exchange exchange(target, comm);
  EXPECT_EQ(exchange.items(), target.size());
  const auto received = exchange.forward(question.data(), 2);
  ASSERT_EQ(received.size(), 2 * exchange.received());
  std::vector<double> answer;
  for (std::size_t k = 0; k < exchange.received(); ++k) {
    EXPECT_EQ((received[2 * k + 1] + received[2 * k] / 1000) % (comm.size() + 1), comm.rank()) << "came to the wrong rank";
    if (k > 0) {
      EXPECT_LT(received[2 * k - 2], received[2 * k]) << "order of ranks, then of items";
    }
    answer.push_back(10.0 * received[2 * k] + comm.rank());
  }
  const auto answers = exchange.backward(answer.data());
  ASSERT_EQ(answers.size(), target.size());
  for (std::size_t i = 0; i < target.size(); ++i) EXPECT_EQ(answers[i], target[i] < 0 ? 0 : 10.0 * question[2 * i] + target[i]);
}

}  // namespace thixis::output
