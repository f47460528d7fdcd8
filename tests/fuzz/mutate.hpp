#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

/// Damaged files: what a bad disk, a program with a fault or a hasty edit makes of a good one.
namespace thixis::fuzz {

/// How many mutants a test tries: `usual`, or $THIXIS_MUTANTS where that is set.
inline int mutants(int usual) {
  const char* wanted = std::getenv("THIXIS_MUTANTS");
  return wanted ? std::atoi(wanted) : usual;
}

/// Damages bytes in one to four places. The same seed does the same on every machine.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::string operator()(std::string bytes) {
    for (auto wounds = 1 + below(2) * below(4); wounds > 0; --wounds) wound(bytes);
    return bytes;
  }

 private:
  struct Span {
    std::size_t begin, size;
  };

  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

  void wound(std::string& bytes) {
    using Way = void (Mutator::*)(std::string&);
    constexpr Way ways[] = {&Mutator::flip,           &Mutator::replace_byte,   &Mutator::truncate,      &Mutator::remove_span,
                            &Mutator::duplicate_span, &Mutator::swap_spans,     &Mutator::remove_line,   &Mutator::duplicate_line,
                            &Mutator::swap_lines,     &Mutator::replace_number, &Mutator::change_number, &Mutator::replace_word};
    if (!bytes.empty()) (this->*ways[below(std::size(ways))])(bytes);
  }

  void flip(std::string& bytes) { bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8)); }
  void replace_byte(std::string& bytes) { bytes[below(bytes.size())] = static_cast<char>(below(256)); }
  void truncate(std::string& bytes) { bytes.resize(below(bytes.size())); }

  void remove_span(std::string& bytes) { remove(bytes, span(bytes)); }
  void duplicate_span(std::string& bytes) { duplicate(bytes, span(bytes)); }
  void swap_spans(std::string& bytes) { swap(bytes, span(bytes), span(bytes)); }
  void remove_line(std::string& bytes) { remove(bytes, line(bytes)); }
  void duplicate_line(std::string& bytes) { duplicate(bytes, line(bytes)); }
  void swap_lines(std::string& bytes) { swap(bytes, line(bytes), line(bytes)); }

  /// A number that is written as text becomes one at the ends of some type, or none.
  void replace_number(std::string& bytes) {
    constexpr const char* extremes[] = {"-1",
                                        "0",
                                        "1",
                                        "2147483647",
                                        "2147483648",
                                        "-2147483648",
                                        "-2147483649",
                                        "4294967295",
                                        "4294967296",
                                        "9223372036854775807",
                                        "9223372036854775808",
                                        "-9223372036854775808",
                                        "18446744073709551615",
                                        "99999999999999999999999",
                                        "1e308",
                                        "-1e308",
                                        "1e309",
                                        "1e-320",
                                        "0.5",
                                        "nan",
                                        "inf",
                                        "-inf",
                                        "0x10",
                                        "1e5",
                                        ""};
    const Span old = number(bytes);
    bytes.replace(old.begin, old.size, extremes[below(std::size(extremes))]);
  }
  /// A whole number becomes its neighbour.
  void change_number(std::string& bytes) {
    const Span old = number(bytes);
    const long long value = std::atoll(bytes.substr(old.begin, std::min<std::size_t>(old.size, 18)).c_str());
    bytes.replace(old.begin, old.size, std::to_string(value + (below(2) == 0 ? 1 : -1)));
  }
  /// Four or eight bytes become a number at the ends of some type, or the neighbour of the whole number they are, in either order of bytes.
  void replace_word(std::string& bytes) {
    constexpr std::uint64_t extremes[] = {0,
                                          1,
                                          0x7fffffff,
                                          0x80000000,
                                          0xffffffff,
                                          0x100000000,
                                          0x7fffffffffffffff,
                                          0x8000000000000000,
                                          0xffffffffffffffff,
                                          0x7ff0000000000000,
                                          0x7ff8000000000000,
                                          0x7fe1ccf385ebc8a0};
    std::array<char, 8> word{};
    const std::size_t size = std::min<std::size_t>(below(2) == 0 ? 4 : 8, bytes.size()), begin = below(bytes.size() - size + 1);
    std::memcpy(word.data(), bytes.data() + begin, size);
    std::uint64_t value = 0;
    std::memcpy(&value, word.data(), sizeof value);
    const std::size_t choice = below(std::size(extremes) + 4);
    value = choice < std::size(extremes) ? extremes[choice] : choice % 2 == 0 ? value + 1 : value - 1;
    std::memcpy(word.data(), &value, sizeof value);
    if (below(4) == 0) std::reverse(word.begin(), word.begin() + size);
    bytes.replace(begin, size, word.data(), size);
  }

  Span span(const std::string& bytes) {
    const std::size_t begin = below(bytes.size());
    return {begin, std::min(bytes.size() - begin, 1 + below(std::size_t(1) << below(11)))};
  }
  Span line(const std::string& bytes) {
    const std::size_t inside = below(bytes.size());
    const std::size_t before = inside == 0 ? std::string::npos : bytes.rfind('\n', inside - 1), after = bytes.find('\n', inside);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    return {begin, (after == std::string::npos ? bytes.size() : after + 1) - begin};
  }
  Span number(const std::string& bytes) {
    constexpr const char *digits = "0123456789", *parts = "0123456789+-.eE";
    std::size_t inside = bytes.find_first_of(digits, below(bytes.size()));
    if (inside == std::string::npos) inside = bytes.find_first_of(digits);
    if (inside == std::string::npos) return {below(bytes.size()), 0};
    const std::size_t before = bytes.find_last_not_of(parts, inside), after = bytes.find_first_not_of(parts, inside);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    return {begin, (after == std::string::npos ? bytes.size() : after) - begin};
  }

  static void remove(std::string& bytes, Span span) { bytes.erase(span.begin, span.size); }
  static void duplicate(std::string& bytes, Span span) { bytes.insert(span.begin, bytes.substr(span.begin, span.size)); }
  static void swap(std::string& bytes, Span one, Span other) {
    if (other.begin < one.begin) std::swap(one, other);
    if (other.begin < one.begin + one.size) return;
    const std::string first = bytes.substr(one.begin, one.size), second = bytes.substr(other.begin, other.size);
    bytes.replace(other.begin, other.size, first);
    bytes.replace(one.begin, one.size, second);
  }

  std::mt19937_64 random_;
};

inline std::string mutant(const std::string& whole, std::uint64_t seed) { return Mutator(seed)(whole); }

}  // namespace thixis::fuzz
