#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace thixis::mesh {

/// The text fit for a message: short, and without what a terminal obeys.
std::string printable(std::string_view text);

/// The bytes of a Gmsh file from front to back: sections and their lines, and numbers as text or binary. In text a row of numbers is a
/// line. Whatever is missing, left over or out of range throws InputError with the line of the file (the byte, in binary).
class MshSource {
 public:
  /// `name`: how messages call the file.
  MshSource(std::string bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {}
  const std::string& name() const { return name_; }

  /// Enters the next section and gives its name without the "$"; empty at the end of the file.
  std::string next_section();
  void end_section();
  void skip_section();

  /// From here on numbers are binary. What follows is the number 1, which shows the order of bytes.
  void enter_binary();
  bool binary() const { return binary_; }

  int integer();        ///< 32 bit
  std::int64_t size();  ///< 64 bit, not negative
  double real();        ///< finite or not
  double coordinate();  ///< finite, at most 1e100
  void end_row();       ///< in binary nothing

  /// The same for lines that are text even in a binary file.
  int text_integer();
  std::string_view text();  ///< the rest of the line, without spaces around it
  std::string_view word();
  void end_line();

  /// `claimed` things of at least `numbers` numbers each, as a size: the rest of the file must be able to hold them.
  std::size_t count(std::int64_t claimed, std::size_t numbers) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  template <class T>
  T number(const char* kind);
  template <class T>
  T from_text(const char* kind);
  bool at_end() const { return at_ == bytes_.size(); }
  void skip_blanks();
  void skip_space();

  std::string bytes_, name_, section_;
  std::size_t at_ = 0;
  bool binary_ = false, swapped_ = false;
};

}  // namespace thixis::mesh
