#include "frames.hpp"

#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <optional>
#include <vector>

#include "hdf5/hdf5_reader.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

namespace fs = std::filesystem;

const std::string frames_folder = "fields";

/// The number of the frame to which a file belongs, finished or not.
std::optional<int> number_of(const fs::path& file) {
  const fs::path finished = file.extension() == ".part" ? file.stem() : file.filename();
  if (finished.extension() != ".h5") return {};
  const std::string digits = finished.stem().string();
  int number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0) return {};
  return number;
}

std::string can_not_go_on(const std::string& path, const char* reason) {
  return fmt::format("The fields can not go on in time: the file '{}' is {}; begin anew with 'thixis run'.", path, reason);
}

/// Every array of the group is there.
void check_arrays(const Hdf5Reader& file, const std::string& group) {
  for (const std::string& array : file.entries(group)) file.rows(fmt::format("{}/{}", group, array));
}

}  // namespace

std::string Frames::name(int frame) { return fmt::format("{}/{:06}.h5", frames_folder, frame); }
std::string Frames::path(int frame) const { return (fs::path(folder_) / name(frame)).string(); }

void Frames::make_folder() const {
  const fs::path place = fs::path(folder_) / frames_folder;
  std::error_code error;
  if (fs::is_symlink(place, error))
    throw core::FileError(
        fmt::format("The fields can not be written: '{}' is a link, and nothing is written through links; remove it, or "
                    "name another folder by output/directory in the deck or by --output.",
                    place.string()));
  fs::create_directories(place, error);
  if (error) throw core::FileError(fmt::format("The folder '{}' can not be made: {}.", place.string(), error.message()));
}

void Frames::remove_from(int first) const {
  std::error_code unreadable;
  std::vector<fs::path> obsolete;
  for (const auto& entry : fs::directory_iterator(fs::path(folder_) / frames_folder, unreadable)) {
    const auto number = number_of(entry.path());
    if (number && (*number >= first || entry.path().extension() == ".part")) obsolete.push_back(entry.path());
  }
  for (const fs::path& file : obsolete) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw core::FileError(fmt::format("The file '{}' can not be removed: {}.", file.string(), error.message()));
  }
}

void Frames::remove() const {
  remove_from(0);
  std::error_code not_empty;
  fs::remove(fs::path(folder_) / frames_folder, not_empty);
}

StoredFrame Frames::read(int frame, int mesh_before) const {
  const std::string place = path(frame), damaged = can_not_go_on(place, "damaged");
  std::error_code unknown;
  if (!fs::exists(place, unknown)) throw core::FileError(can_not_go_on(place, "missing"));
  core::RegularFile sealed(place);
  if (!sealed.open() || look_at_seal(sealed, seal()).state != SealState::whole) throw core::FileError(damaged);
  const Hdf5Reader file(place, damaged);
  const std::string fields = fmt::format("/fields_{}", frame), mesh = fmt::format("/mesh_{}", frame);
  StoredFrame stored;
  stored.time = file.number(fields, "time");
  stored.mesh = static_cast<int>(file.integer(fields, "mesh"));
  stored.xdmf = file.text("/xdmf");
  check_arrays(file, fields);
  if (stored.mesh == frame) {
    stored.fingerprint = static_cast<std::uint64_t>(file.integer(mesh, "fingerprint"));
    check_arrays(file, mesh);
  } else if (stored.mesh != mesh_before) {
    throw core::FileError(damaged);
  }
  return stored;
}

}  // namespace thixis::output
