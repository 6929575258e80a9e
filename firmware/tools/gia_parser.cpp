#include "firmware/tools/gia_parser.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/tools/gia_statement.h"

namespace dendro::tools {
namespace {

using namespace bps32;

/// An open structured statement.
struct Frame {
  enum Kind : std::uint8_t { kIf, kElse, kWhile, kDo, kCount, kForever };
  Kind kind = kIf;
  Token at;
  int start = -1;  ///< label of the body
  int next = -1;   ///< label of `continue`; of the else part for kIf
  int end = -1;    ///< label behind the statement
  Condition condition;
};

class Parser {
 public:
  Parser(std::string_view source, const std::string& file, unsigned scratch_words)
      : program_{},
        tokens_(tokenize(source, file)),
        cursor_(tokens_, set_file(file)),
        symbols_(tokens_, program_, scratch_words),
        lookup_([this](const Token& t) { return named_label(t); }) {}

  Program parse() {
    while (cursor_.peek().kind != Token::kEnd) statement();
    if (!frames_.empty()) cursor_.fail(frames_.back().at, "the '{' of this statement is never closed");
    if (program_.micros.empty()) cursor_.fail("there is no microinstruction in this source");
    for (const Label& label : program_.labels) {
      if (label.at >= 0) continue;
      Token t;
      t.line = label.line;
      t.column = label.column;
      cursor_.fail(t, "the label '" + label.name + "' is not defined");
    }
    return std::move(program_);
  }

 private:
  const std::string& set_file(const std::string& file) {
    program_.file = file;
    return program_.file;
  }

  int new_label(const std::string& name, const Token& at) {
    Label label;
    label.name = name;
    label.line = at.line;
    label.column = at.column;
    program_.labels.push_back(label);
    return static_cast<int>(program_.labels.size()) - 1;
  }

  int named_label(const Token& t) {
    const auto it = names_.find(t.text);
    if (it != names_.end()) return it->second;
    if (symbols_.is_declared(t.text))
      cursor_.fail(t, "'" + t.text + "' is no label: it is declared as something else");
    if (!is_free_name(t.text)) cursor_.fail(t, "'" + t.text + "' is a word of the language and no label");
    const int n = new_label(t.text, t);
    names_[t.text] = n;
    return n;
  }

  void define(int label) { program_.labels[static_cast<std::size_t>(label)].at = here(); }
  int here() const { return static_cast<int>(program_.micros.size()); }

  void define_named(const Token& t) {
    Label& label = program_.labels[static_cast<std::size_t>(named_label(t))];
    if (label.at >= 0) {
      cursor_.fail(t, fmt::format("the label '{}' is defined twice: first in line {}", t.text, label.line));
    }
    label.at = here();
    label.line = t.line;
    label.column = t.column;
  }

  void emit_jump(unsigned op, const Condition& c, bool inverted, int label, const Token& at) {
    Micro m;
    m.word = put(m.word, kSeq, op);
    m.word = put(m.word, kCond, c.code);
    m.word = put(m.word, kPol, inverted ? 1 : 0);
    m.imm.kind = Fixup::kLabel;
    m.imm.index = label;
    m.line = at.line;
    m.column = at.column;
    m.old_condition = c.old;
    program_.micros.push_back(m);
  }

  Condition bracketed_condition(const char* where) {
    cursor_.expect("(", where);
    const Condition c = parse_condition(cursor_);
    cursor_.expect(")", "after the condition");
    return c;
  }

  void statement() {
    const Token t = cursor_.peek();
    if (Symbols::skip_declaration(cursor_)) return;
    if (t.is("entry")) return entry();
    if (t.is("}")) return close();
    if (t.is("if") && if_block()) return;
    if (t.is("while")) return open_while();
    if (t.is("do") || t.is("forever")) return open_plain(t.is("do") ? Frame::kDo : Frame::kForever);
    if (t.is("for") || (t.is("loop") && !cursor_.peek(1).is(";") && !cursor_.peek(1).is(",")))
      return open_count();
    if (t.is("break") || t.is("continue")) return leave();
    const bool pair = symbols_.register_number(t.text) >= 0 && cursor_.peek(2).is("q");
    if (t.kind == Token::kIdentifier && cursor_.peek(1).is(":") && !pair) {
      if (symbols_.register_number(t.text) >= 0)
        cursor_.fail(t, "'" + t.text + "' is a register and no label");
      cursor_.take();
      cursor_.take();
      return define_named(t);
    }
    const Micro m = parse_statement(cursor_, symbols_, program_, lookup_);
    guard_counter(m, t);
    program_.micros.push_back(m);
  }

  /// A counted loop keeps its count in the one counter of the sequencer.
  void guard_counter(const Micro& m, const Token& at) {
    const Frame* loop = counted();
    if (!loop) return;
    const unsigned seq = get(m.word, kSeq);
    const bool loads =
        seq == am2910::kLDCT || (seq == am2910::kPUSH && !(get(m.word, kPol) && !get(m.word, kCond)));
    const bool counts = seq == am2910::kRFCT || seq == am2910::kRPCT || seq == am2910::kTWB;
    if (loads || counts) {
      cursor_.fail(at, fmt::format("the counter is in use by the loop of line {}", loop->at.line));
    }
  }

  const Frame* counted() const {
    const auto it =
        std::find_if(frames_.begin(), frames_.end(), [](const Frame& f) { return f.kind == Frame::kCount; });
    return it == frames_.end() ? nullptr : &*it;
  }

  void entry() {
    const Token at = cursor_.take();
    if (has_entry_) cursor_.fail(at, "there is one entry");
    has_entry_ = true;
    if (cursor_.peek().kind == Token::kIdentifier && !symbols_.is_constant(cursor_.peek().text)) {
      program_.entry_label = named_label(cursor_.take());
    } else {
      const std::int64_t v = symbols_.expression(cursor_);
      if (v < 0 || v > 4095) cursor_.fail(at, "the entry is a label or an address of 0 to 4095");
      program_.entry_address = static_cast<std::uint32_t>(v);
    }
    cursor_.expect(";", "after the entry");
  }

  Frame& open(Frame::Kind kind, const Token& at) {
    Frame f;
    f.kind = kind;
    f.at = at;
    f.start = new_label("", at);
    f.next = new_label("", at);
    f.end = new_label("", at);
    frames_.push_back(f);
    return frames_.back();
  }

  bool if_block() {
    const std::size_t before = cursor_.position();
    const Token at = cursor_.take();
    const Condition c = bracketed_condition("after if");
    if (!cursor_.accept("{")) {
      cursor_.seek(before);
      return false;
    }
    const Frame& f = open(Frame::kIf, at);
    emit_jump(am2910::kCJP, c, !c.inverted, f.next, at);
    define(f.start);
    return true;
  }

  void open_while() {
    const Token at = cursor_.take();
    const Condition c = bracketed_condition("after while");
    cursor_.expect("{", "after the condition");
    Frame& f = open(Frame::kWhile, at);
    f.condition = c;
    emit_jump(am2910::kCJP, c, !c.inverted, f.end, at);
    define(f.start);
  }

  void open_plain(Frame::Kind kind) {
    const Token at = cursor_.take();
    cursor_.expect("{", "after " + at.text);
    define(open(kind, at).start);
  }

  void open_count() {
    const Token at = cursor_.take();
    if (const Frame* outer = counted()) {
      cursor_.fail(
          at, fmt::format("the counter is in use by the loop of line {}: a loop inside counts in a register",
                          outer->at.line));
    }
    const bool bracket = cursor_.peek().is("(") && !symbols_.constant_ahead(cursor_);
    if (bracket) cursor_.take();
    Micro m = parse_loop_count(cursor_, symbols_, program_, lookup_);
    if (bracket) cursor_.expect(")", "after the loop count");
    cursor_.expect("{", "after the loop count");
    program_.micros.push_back(m);
    define(open(Frame::kCount, at).start);
  }

  void leave() {
    const Token at = cursor_.take();
    cursor_.expect(";", "after " + at.text);
    for (auto f = frames_.rbegin(); f != frames_.rend(); ++f) {
      if (f->kind == Frame::kIf || f->kind == Frame::kElse) continue;
      emit_jump(am2910::kCJP, {}, false, at.is("break") ? f->end : f->next, at);
      return;
    }
    cursor_.fail(at, "'" + at.text + "' stands outside a loop");
  }

  void close() {
    const Token at = cursor_.take();
    if (frames_.empty()) cursor_.fail(at, "this '}' closes nothing");
    Frame f = frames_.back();
    frames_.pop_back();
    switch (f.kind) {
      case Frame::kIf:
        if (cursor_.accept("else")) {
          cursor_.expect("{", "after else");
          emit_jump(am2910::kCJP, {}, false, f.end, at);
          define(f.next);
          f.kind = Frame::kElse;
          frames_.push_back(f);
          return;
        }
        define(f.next);
        break;
      case Frame::kElse:
        break;
      case Frame::kWhile:
        define(f.next);
        emit_jump(am2910::kCJP, f.condition, f.condition.inverted, f.start, at);
        break;
      case Frame::kDo:
        define(f.next);
        close_do(f, at);
        break;
      case Frame::kCount:
        define(f.next);
        emit_jump(am2910::kRPCT, {}, false, f.start, at);
        break;
      case Frame::kForever:
        define(f.next);
        emit_jump(am2910::kCJP, {}, false, f.start, at);
        break;
    }
    define(f.end);
  }

  void close_do(const Frame& f, const Token& at) {
    cursor_.expect("while", "after the '}' of do");
    const Condition c = bracketed_condition("after while");
    cursor_.expect(";", "after the condition");
    emit_jump(am2910::kCJP, c, c.inverted, f.start, at);
  }

  Program program_;
  std::vector<Token> tokens_;
  TokenCursor cursor_;
  Symbols symbols_;
  LabelLookup lookup_;
  std::map<std::string, int> names_;
  std::vector<Frame> frames_;
  bool has_entry_ = false;
};

}  // namespace

Program parse_program(std::string_view source, const std::string& file, unsigned scratch_words) {
  return Parser(source, file, scratch_words).parse();
}

}  // namespace dendro::tools
