#include "thixis/output/checkpoint.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "files/aside.hpp"
#include "hash.hpp"
#include "hdf5/hdf5_file.hpp"
#include "hdf5/hdf5_reader.hpp"
#include "seal.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"
#include "thixis/core/text.hpp"

namespace thixis::output {
namespace {

const Seal our_seal{"thixis checkpoint", 2};

constexpr GlobalIndex most_levels = 100000;  ///< of a hierarchy of meshes

[[noreturn]] void wrong(const std::string& sentence) { throw core::Error(core::ExitCode::internal, sentence); }

std::string place_of(const std::string& block) { return "/blocks/" + block; }

/// The same for equal (id, value) pairs, whatever rank holds them; collective.
std::uint64_t checksum(const std::vector<GlobalIndex>& ids, const std::vector<double>& values, const core::Comm& comm) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) sum += mixed(mixed(0, static_cast<std::uint64_t>(ids[i])), bits(values[i]));
  const auto sums = comm.gather(sum);
  return std::accumulate(sums.begin(), sums.end(), std::uint64_t{0});
}

/// A part of a block: consecutive rows of the sorted whole.
struct Rows {
  Slab slab;
  std::vector<GlobalIndex> ids;
  std::vector<double> values;
};

/// Collective: the rows that this rank reads, proven to be what was written.
Rows read_rows(const Hdf5Reader& file, const std::string& block, const std::string& complaint, const core::Comm& comm) {
  const std::string place = place_of(block);
  Rows rows;
  const GlobalIndex expected = comm.together([&] {
    rows.slab = even_slab(file.length(place + "/ids"), comm);
    if (file.length(place + "/values") != rows.slab.total) throw core::FileError(complaint);
    rows.ids = file.integers(place + "/ids", rows.slab);
    rows.values = file.numbers(place + "/values", rows.slab);
    return file.integer(place, "checksum");
  });
  if (static_cast<GlobalIndex>(checksum(rows.ids, rows.values, comm)) != expected) throw core::FileError(complaint);
  return rows;
}

/// The rank that sorts an id: the range of ids is shared evenly.
std::vector<int> sorting_ranks(const CheckpointBlock& block, const core::Comm& comm) {
  comm.together([&] {
    check_entry_name("block", block.name);
    if (block.ids.size() != block.values.size())
      wrong(fmt::format("The block '{}' has {} ids and {} values.", block.name, block.ids.size(), block.values.size()));
    for (const GlobalIndex id : block.ids)
      if (id < 0) wrong(fmt::format("The block '{}' has the id {}.", block.name, id));
  });
  const GlobalIndex largest = block.ids.empty() ? -1 : *std::max_element(block.ids.begin(), block.ids.end());
  const GlobalIndex height = slab_height(comm.max(largest) + 1, comm);
  std::vector<int> target;
  target.reserve(block.ids.size());
  for (const GlobalIndex id : block.ids) target.push_back(static_cast<int>(id / height));
  return target;
}

/// Collective: the block in the order of its ids.
Rows sorted(const CheckpointBlock& block, const core::Comm& comm) {
  const Exchange exchange(sorting_ranks(block, comm), comm);
  const auto ids = exchange.forward(block.ids.data());
  const auto values = exchange.forward(block.values.data());
  std::vector<LocalIndex> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](LocalIndex i, LocalIndex j) { return ids[i] < ids[j]; });
  Rows rows;
  for (const LocalIndex i : order) {
    rows.ids.push_back(ids[i]);
    rows.values.push_back(values[i]);
  }
  comm.together([&] {
    const auto twice = std::adjacent_find(rows.ids.begin(), rows.ids.end());
    if (twice != rows.ids.end()) wrong(fmt::format("The block '{}' has the id {} twice.", block.name, *twice));
  });
  const auto count = static_cast<GlobalIndex>(rows.ids.size());
  rows.slab = {comm.offset(count), count, comm.sum(count)};
  return rows;
}

/// At most so many bytes does the file take.
long long room_of(const Checkpoint& checkpoint, const core::Comm& comm) {
  long long room = 4 * group_bytes + 3 * array_bytes + static_cast<long long>(checkpoint.deck.size() + checkpoint.folder.size()) +
                   256 * static_cast<long long>(checkpoint.attributes.size());
  for (const auto& block : checkpoint.blocks)
    room += group_bytes + 2 * array_bytes + 16 * comm.sum(static_cast<GlobalIndex>(block.ids.size()));
  return room;
}

void write_content(const std::string& path, const Checkpoint& checkpoint, const core::Comm& comm) {
  Hdf5File file(path, Hdf5File::Mode::create, room_of(checkpoint, comm), comm, seal_bytes);
  file.add_attribute("/", "level", static_cast<GlobalIndex>(checkpoint.level));
  file.add_text("/deck", checkpoint.deck);
  file.add_text("/folder", checkpoint.folder);
  file.add_group("/attributes");
  for (const auto& [name, value] : checkpoint.attributes) file.add_attribute("/attributes", name, value);
  file.add_group("/blocks");
  for (const auto& block : checkpoint.blocks) {
    const Rows rows = sorted(block, comm);
    const std::string place = place_of(block.name);
    file.add_group(place);
    file.add_attribute(place, "checksum", static_cast<GlobalIndex>(checksum(rows.ids, rows.values, comm)));
    file.add_array(place + "/ids", rows.slab, 1, rows.ids);
    file.add_array(place + "/values", rows.slab, 1, rows.values);
  }
  file.sync();
  file.close();
}

/// Throws FileError unless the file gives back what was written: only then may it take the place of an older checkpoint. Collective.
void prove(const std::string& path, const Checkpoint& checkpoint, const core::Comm& comm) {
  const std::string complaint = fmt::format(
      "The checkpoint can not be written: '{}' does not read back as it was written; an older checkpoint stays as it is.", path);
  const auto file = comm.together([&] { return std::make_shared<Hdf5Reader>(path, complaint); });
  comm.together([&] {
    bool same = file->integer("/", "level") == checkpoint.level && file->text("/deck") == checkpoint.deck &&
                file->text("/folder") == checkpoint.folder && file->entries("/blocks").size() == checkpoint.blocks.size() &&
                file->attributes("/attributes").size() == checkpoint.attributes.size();
    for (const auto& [name, value] : checkpoint.attributes) same = same && bits(file->number("/attributes", name)) == bits(value);
    if (!same) throw core::FileError(complaint);
  });
  for (const auto& block : checkpoint.blocks) {
    const Rows rows = read_rows(*file, block.name, complaint, comm);
    if (checksum(rows.ids, rows.values, comm) != checksum(block.ids, block.values, comm)) throw core::FileError(complaint);
  }
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint, const core::Comm& comm) {
  write_aside(path, comm, [&](const std::string& temporary) {
    write_content(temporary, checkpoint, comm);
    comm.on_root([&] { write_seal(temporary, our_seal); });
    prove(temporary, checkpoint, comm);
  });
}

struct StoredCheckpoint::File : Hdf5Reader {
  using Hdf5Reader::Hdf5Reader;
};

namespace {

std::string damaged(const std::string& path) {
  return fmt::format("The checkpoint '{}' is damaged; go on from another one, or begin anew with 'thixis run'.", core::one_line(path));
}

/// Throws FileError unless this is a checkpoint of this program, with every byte that was written.
void check_seal(const std::string& path) {
  using State = core::RegularFile::State;
  const auto refuse = [](const std::string& sentence) { throw core::FileError(sentence); };
  const std::string shown = core::one_line(path);
  core::RegularFile file(path);
  if (file.state() == State::absent)
    refuse(fmt::format("There is no checkpoint '{}'; give the checkpoint.h5 in the output directory of a run.", shown));
  if (file.state() == State::folder) refuse(fmt::format("'{}' is a folder; give the checkpoint.h5 in it.", shown));
  if (file.state() == State::special)
    refuse(fmt::format("'{}' is no regular file, but a pipe or a device; give the checkpoint.h5 in the output directory of a run.", shown));
  if (file.state() == State::unreadable) refuse(fmt::format("'{}' can not be read; check its permissions.", shown));
  const SealFound found = look_at_seal(file, our_seal);
  if (found.state == SealState::none)
    refuse(
        fmt::format("'{}' is no checkpoint of Thixis, or one of an older version, without a seal; give the checkpoint.h5 in the output "
                    "directory of a run, or use the Thixis that wrote it.",
                    shown));
  if (found.state == SealState::other_format)
    refuse(fmt::format("The checkpoint '{}' has format {}, this program reads format {}; use the Thixis that wrote it.", shown,
                       found.format, our_seal.format));
  if (found.state == SealState::damaged) refuse(damaged(path));
}

}  // namespace

StoredCheckpoint::StoredCheckpoint(std::string path, const core::Comm& comm) : path_(std::move(path)), comm_(comm) {
  comm_.on_root([&] { check_seal(path_); });
  comm_.together([&] {
    file_ = std::make_unique<File>(path_, damaged(path_));
    head_.deck = file_->text("/deck");
    head_.folder = file_->text("/folder");
    const GlobalIndex level = file_->integer("/", "level");
    if (level < -1 || level > most_levels) throw wrong_number("level", static_cast<double>(level));
    head_.level = static_cast<int>(level);
    for (const auto& name : file_->attributes("/attributes")) head_.attributes[name] = file_->number("/attributes", name);
    for (const auto& name : file_->entries("/blocks")) head_.blocks.push_back({name, {}, {}});
  });
}
StoredCheckpoint::~StoredCheckpoint() = default;
StoredCheckpoint::StoredCheckpoint(StoredCheckpoint&&) noexcept = default;
StoredCheckpoint& StoredCheckpoint::operator=(StoredCheckpoint&&) noexcept = default;

StoredCheckpoint read_checkpoint(const std::string& path, const core::Comm& comm) { return {path, comm}; }

double StoredCheckpoint::attribute(const std::string& name) const {
  const auto found = head_.attributes.find(name);
  if (found == head_.attributes.end()) throw core::FileError(fmt::format("The checkpoint '{}' does not hold '{}'.", path_, name));
  return found->second;
}

core::FileError StoredCheckpoint::wrong_number(const std::string& name, double value) const {
  return core::FileError(fmt::format("{} No run has {} as its '{}'.", damaged(path_), value, name));
}

double StoredCheckpoint::number(const std::string& name, double least) const {
  const double value = attribute(name);
  if (!(std::isfinite(value) && value >= least)) throw wrong_number(name, value);
  return value;
}

GlobalIndex StoredCheckpoint::count(const std::string& name, GlobalIndex most) const {
  const double value = number(name, 0);
  if (value > static_cast<double>(most) || value != std::floor(value)) throw wrong_number(name, value);
  return static_cast<GlobalIndex>(value);
}

GlobalIndex StoredCheckpoint::size(const std::string& block) const {
  const bool known = std::any_of(head_.blocks.begin(), head_.blocks.end(), [&](const auto& b) { return b.name == block; });
  return known ? file_->length(place_of(block) + "/ids") : -1;
}

namespace {

/// The rank that has read each of the ids, if any has. Collective.
std::vector<int> reading_ranks(const std::vector<GlobalIndex>& ids, const Rows& rows, const core::Comm& comm) {
  const auto first = comm.gather(rows.ids.empty() ? std::numeric_limits<GlobalIndex>::max() : rows.ids.front());
  std::vector<int> target;
  target.reserve(ids.size());
  for (const GlobalIndex id : ids) {
    const auto next = std::upper_bound(first.begin(), first.end(), id);
    target.push_back(std::max(0, static_cast<int>(next - first.begin()) - 1));
  }
  return target;
}

}  // namespace

CheckpointBlock list_block(const std::string& name, const std::vector<GlobalIndex>& list, bool root) {
  CheckpointBlock block{name, {}, {}};
  if (!root) return block;
  block.ids.resize(list.size());
  std::iota(block.ids.begin(), block.ids.end(), 0);
  block.values.assign(list.begin(), list.end());
  return block;
}

std::vector<double> StoredCheckpoint::fetch(const std::string& block, const std::vector<GlobalIndex>& ids) const {
  if (size(block) < 0) throw core::FileError(fmt::format("The checkpoint '{}' does not hold '{}'.", path_, block));
  const Rows rows = read_rows(*file_, block, damaged(path_), comm_);
  const Exchange exchange(reading_ranks(ids, rows, comm_), comm_);
  const auto wanted = exchange.forward(ids.data());
  const auto answers = comm_.together([&] {
    std::vector<double> found;
    found.reserve(wanted.size());
    for (const GlobalIndex id : wanted) {
      const auto row = std::lower_bound(rows.ids.begin(), rows.ids.end(), id);
      if (row == rows.ids.end() || *row != id)
        throw core::FileError(fmt::format("The checkpoint '{}' has no value of '{}' with the id {}: it belongs to another mesh or method.",
                                          path_, block, id));
      found.push_back(rows.values[row - rows.ids.begin()]);
    }
    return found;
  });
  return exchange.backward(answers.data());
}

std::vector<double> StoredCheckpoint::fetch_finite(const std::string& block, const std::vector<GlobalIndex>& ids) const {
  std::vector<double> values = fetch(block, ids);
  comm_.together([&] {
    const auto wrong_one = std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
    if (wrong_one != values.end()) throw wrong_number(block, *wrong_one);
  });
  return values;
}

std::vector<GlobalIndex> StoredCheckpoint::fetch_list(const std::string& block) const {
  constexpr double exact = 1ll << 53;
  std::vector<GlobalIndex> ids(std::max<GlobalIndex>(0, comm_.together([&] { return size(block); })));
  std::iota(ids.begin(), ids.end(), 0);
  const std::vector<double> values = fetch(block, ids);
  comm_.together([&] {
    for (const double value : values)
      if (!(std::abs(value) <= exact && value == std::floor(value))) throw wrong_number(block, value);
  });
  return {values.begin(), values.end()};
}

}  // namespace thixis::output
