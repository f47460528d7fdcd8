#include "hdf5/slabs.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"

namespace thixis::output {
namespace {

/// Entities 0..total-1 with scattered owners; every rank knows all of them, in falling order.
struct Entities {
  std::vector<GlobalIndex> id;
  std::vector<int> owner;
  Entities(int total, const core::Comm& comm) {
    for (int i = total - 1; i >= 0; --i) {
      id.push_back(i);
      owner.push_back(i * i % comm.size());
    }
  }
};

}  // namespace

TEST(slabs, follow_each_other_and_hold_the_rows_in_order) {
  const core::Comm comm;
  for (const int total : {0, 1, 2, 3, 4, 7, 100}) {
    const Entities entities(total, comm);
    std::vector<double> values;
    for (const GlobalIndex i : entities.id) {
      values.push_back(10.0 * i);
      values.push_back(10.0 * i + 1);
    }
    const SlabExchange exchange(entities.id, entities.owner, total, "thing", comm);
    EXPECT_EQ(exchange.slab().total, total);
    EXPECT_EQ(exchange.slab().begin, comm.offset(exchange.slab().size));
    const std::vector<double> rows = comm.gather(exchange(values.data(), 2, 3));
    ASSERT_EQ(rows.size(), 3u * total);
    for (int i = 0; i < total; ++i)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(rows[3 * i + c], c < 2 ? 10.0 * i + c : 0);
  }
}

TEST(slabs, keep_integers_beyond_the_precision_of_doubles) {
  const core::Comm comm;
  const Entities entities(5, comm);
  std::vector<GlobalIndex> values;
  for (const GlobalIndex i : entities.id) values.push_back((1ll << 60) + i);
  const std::vector<GlobalIndex> rows = comm.gather(SlabExchange(entities.id, entities.owner, 5, "thing", comm)(values.data(), 1, 1));
  EXPECT_EQ(rows, (std::vector<GlobalIndex>{1ll << 60, (1ll << 60) + 1, (1ll << 60) + 2, (1ll << 60) + 3, (1ll << 60) + 4}));
}

TEST(slabs, refuse_entities_without_or_with_two_owners) {
  const core::Comm comm;
  const auto sentence = [&](const Entities& entities) {
    return sentence_of(core::ExitCode::internal, [&] { SlabExchange(entities.id, entities.owner, 4, "thing", comm); });
  };
  Entities nobody(4, comm), two(4, comm), outside(4, comm);
  nobody.owner[2] = comm.size();
  EXPECT_EQ(sentence(nobody), "1 of 4 things have no owner.");
  two.id[2] = two.id[3];
  two.owner[2] = two.owner[3];
  EXPECT_EQ(sentence(two), "The thing 0 has two owners.");
  outside.id[2] = 4;
  outside.owner[2] = 0;
  EXPECT_EQ(sentence(outside), "A thing has the number 4, there are 4.");
}

}  // namespace thixis::output
