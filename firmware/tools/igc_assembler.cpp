#include "firmware/tools/igc_assembler.h"

#include <fmt/format.h>

#include "firmware/tools/gia_lexer.h"
#include "firmware/tools/igc_word.h"
#include "firmware/tools/source_error.h"

namespace dendro::tools {
namespace {

/// Parses programs, loops and words; what a word's parts do is IgcWordBuilder's.
class IgcParser {
 public:
  IgcParser(std::string_view source, const std::string& file, const IgcOptions& options)
      : tokens_(tokenize(source, file)), file_(file), options_(options) {}

  IgcImage parse() {
    while (now().kind != Token::kEnd) {
      if (now().is("register"))
        parse_register();
      else if (now().is("program"))
        parse_program();
      else
        fail("`register` or `program` stands here");
    }
    return std::move(image_);
  }

 private:
  const Token& now() const { return tokens_[at_]; }
  [[noreturn]] void fail(const std::string& message) const { fail_at(now(), message); }
  [[noreturn]] void fail_at(const Token& token, const std::string& message) const {
    throw SourceError(file_, token.line, token.column, message);
  }
  void expect(const char* text) {
    if (!now().is(text))
      fail(fmt::format("`{}` stands here, not `{}`", text, now().kind == Token::kEnd ? "the end" : now().text));
    ++at_;
  }
  Token identifier(const char* what) {
    if (now().kind != Token::kIdentifier) fail(fmt::format("{} stands here", what));
    return tokens_[at_++];
  }

  // register NAME = NUMBER;
  void parse_register() {
    expect("register");
    const Token name = identifier("a register's name");
    expect("=");
    if (now().kind != Token::kNumber || now().value >= igc::kRegisters)
      fail(fmt::format("a register's number is 0..{}", igc::kRegisters - 1));
    if (is_reserved_word(name.text)) fail_at(name, fmt::format("`{}` means something else", name.text));
    if (!image_.registers.emplace(name.text, static_cast<unsigned>(now().value)).second)
      fail_at(name, fmt::format("the register `{}` is declared twice", name.text));
    ++at_;
    expect(";");
  }

  // program NAME [phase NAME] { items }
  void parse_program() {
    expect("program");
    const Token name = identifier("a program's name");
    IgcProgram program;
    program.entry = static_cast<unsigned>(image_.words.size());
    program.phase = name.text;
    if (now().is("phase")) {
      ++at_;
      program.phase = identifier("a phase's name").text;
    }
    words_.clear();
    known_ = {};
    expect("{");
    while (!now().is("}")) parse_item();
    check_program(name);
    ++at_;
    words_.back().end = true;
    for (const igc::MicroWord& word : words_) {
      image_.words.push_back(pack(word));
      program.uses_tree = program.uses_tree || word.tree;
    }
    program.words = static_cast<unsigned>(words_.size());
    if (image_.words.size() > igc::kStoreWords)
      fail_at(name, fmt::format("the control store has {} words", igc::kStoreWords));
    if (!image_.programs.emplace(name.text, program).second)
      fail_at(name, fmt::format("the program `{}` is written twice", name.text));
  }

  void check_program(const Token& name) const {
    for (const igc::MicroWord& word : words_)
      if (word.loop == igc::LoopCount::kNone) return;
    fail_at(name, "a program has at least one word outside loops");
  }

  void parse_item() {
    if (now().is("loop"))
      parse_loop();
    else
      words_.push_back(parse_word(LoopPlace{}));
  }

  // loop COUNT { words }
  void parse_loop() {
    expect("loop");
    LoopPlace place = parse_count();
    expect("{");
    const std::size_t first = words_.size();
    const KnownRegisters before = known_;
    while (!now().is("}")) {
      if (now().kind == Token::kEnd || now().is("loop")) fail("a loop holds words only, and ends with `}`");
      words_.push_back(parse_word(place));
    }
    if (words_.size() == first) fail("a loop has at least one word");
    ++at_;
    words_.back().loop_end = true;
    if (place.may_be_empty) known_ = before;
  }

  LoopPlace parse_count() {
    LoopPlace place;
    const Token token = now();
    ++at_;
    place.text = token.text;
    if (token.kind == Token::kNumber) {
      if (token.value < 1 || token.value > 63) fail_at(token, "a number of turns is 1..63");
      place.count = igc::LoopCount::kNumber, place.number = static_cast<unsigned>(token.value);
      place.turns = place.number;
    } else if (token.is("fraction")) {
      place.count = igc::LoopCount::kFraction, place.may_be_empty = true;
    } else if (token.is("gap")) {
      place.count = igc::LoopCount::kGap, place.may_be_empty = true;
    } else if (token.is("guard")) {
      place.count = igc::LoopCount::kGuard;
      if (now().is("-")) {
        ++at_;
        if (now().kind != Token::kNumber || now().value != 1) fail("only `guard - 1` can be counted");
        ++at_;
        place.count = igc::LoopCount::kGuardLessOne, place.may_be_empty = true;
      }
    } else {
      const auto number = image_.registers.find(token.text);
      if (token.kind != Token::kIdentifier || number == image_.registers.end())
        fail_at(token, "a loop counts a number, gap, fraction, guard, guard - 1 or a register");
      place.count = igc::LoopCount::kRegister, place.number = number->second;
      const auto value = options_.registers.find(token.text);
      if (value != options_.registers.end()) place.turns = value->second;
    }
    return place;
  }

  igc::MicroWord parse_word(const LoopPlace& place) {
    IgcWordBuilder builder(file_, options_, image_.registers, place, known_);
    for (;;) {
      at_ = builder.add_part(tokens_, at_);
      if (!now().is(",")) break;
      ++at_;
    }
    expect(";");
    return builder.finish();
  }

  std::vector<Token> tokens_;
  const std::string& file_;
  const IgcOptions& options_;
  std::size_t at_ = 0;
  IgcImage image_;
  std::vector<igc::MicroWord> words_;
  KnownRegisters known_;
};

}  // namespace

IgcImage assemble_igc(std::string_view source, const std::string& file_name, const IgcOptions& options) {
  return IgcParser(source, file_name, options).parse();
}

}  // namespace dendro::tools
