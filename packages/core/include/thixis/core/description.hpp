#pragma once
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace thixis::core {

/// A number or an expression of the deck: type="double", "int" or "string" there. No text: not given. Its syntax is checked by its user.
struct Formula {
  std::string text;
  bool empty() const { return text.empty(); }
  friend bool operator==(const Formula& a, const Formula& b) { return a.text == b.text; }
  friend bool operator!=(const Formula& a, const Formula& b) { return !(a == b); }
};

/// Which values a parameter may take; for an array: each of its entries. `rule()` is the text that follows "must be".
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false, upper_open = false;
  std::vector<std::string> names;  ///< allowed texts; empty: any
  std::vector<double> numbers;     ///< allowed numbers; empty: any
  int least_entries = 0;           ///< of an array
  int most_entries = std::numeric_limits<int>::max();

  Range& entries(int count) { return entries(count, count); }
  Range& entries(int least, int most);
  bool holds(double value) const;
  std::string rule() const;  ///< "at least 1", "between 0 and 1", "one of 1, 2"; empty if anything goes
};
Range at_least(double bound);
Range at_most(double bound);
Range above(double bound);
Range below(double bound);
Range between(double lower, double upper);           ///< both included
Range strictly_between(double lower, double upper);  ///< both excluded
Range one_of(std::initializer_list<const char*> names);
Range one_of(std::initializer_list<int> numbers);
Range entries(int count);  ///< an array of so many entries
Range entries(int least, int most);

/// Where the checks of a schema report what they find; see Schema::check.
class Problems {
 public:
  virtual ~Problems() = default;
  /// The parameter or block at `path` ("degree", "initial/u1"; "" is the block itself), relative to the block being checked, is wrong:
  /// the message gets the place where it stands. `sentence` says what to write instead. Ignored where a mistake was found before.
  virtual void add(const std::string& path, const std::string& sentence) = 0;
  /// Whether the deck (or --set) gives the parameter or block at `path`.
  virtual bool given(const std::string& path) const = 0;
};

/// The description of one block with the types erased: what Schema<P> builds and what reader, writer and `describe` walk through.
/// Blocks are described by `Schema<P>`; only core itself looks in here.
class Description {
 public:
  enum class Kind { boolean, integer, long_integer, real, text, formula, reals, integers, texts };
  using Value = std::variant<bool, long long, double, std::string, std::vector<double>, std::vector<int>, std::vector<std::string>>;

  struct Parameter {
    std::string name;
    Kind kind = Kind::text;
    Range range;
    std::string sentence;
    bool required = false;
    bool exemplary = false;  ///< shown by a skeleton deck, though it may be left out
    std::function<void(void* object, const Value& value)> set;
    std::function<std::optional<Value>(const void* object)> get;  ///< nothing: not given
  };
  /// A sublist. `single`: one struct. Otherwise its members have free names and are structs (`inside`) or numbers (`value`).
  struct Block {
    std::string name;
    std::string sentence;
    bool required = false;
    bool single = true;
    std::shared_ptr<const Description> inside;
    std::optional<Parameter> value;
    bool always = true;                                                  ///< single and not optional: exists without being given
    std::function<void*(void* object, const std::string& member)> open;  ///< the member, created if missing
    std::function<std::vector<std::pair<std::string, const void*>>(const void* object)> members;
  };

  Description(std::string name, std::string sentence, std::function<std::shared_ptr<void>()> make)
      : name_(std::move(name)), sentence_(std::move(sentence)), make_(std::move(make)) {}
  void add(Parameter parameter);
  void add(Block block);
  void add_check(std::function<void(const void*, Problems&)> check) { checks_.push_back(std::move(check)); }
  /// Takes over what describes a part of the object: `open` and `look` find it.
  void adopt(const Description& of_part, const std::function<void*(void* object)>& open,
             const std::function<const void*(const void* object)>& look);
  void require_last();
  void show_last() { parameters_.back().exemplary = true; }

  const std::string& name() const { return name_; }
  const std::string& sentence() const { return sentence_; }
  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  const Parameter* parameter(const std::string& name) const;
  const Block* block(const std::string& name) const;
  std::shared_ptr<void> make() const { return make_(); }  ///< a struct with all defaults
  void check(const void* object, Problems& problems) const;

 private:
  void must_be_new(const std::string& name) const;
  std::string name_, sentence_;
  std::function<std::shared_ptr<void>()> make_;
  std::vector<Parameter> parameters_;
  std::vector<Block> blocks_;
  std::vector<std::function<void(const void*, Problems&)>> checks_;
  bool last_is_block_ = false;
};

enum class Format { text, markdown, xml };

}  // namespace thixis::core
