#include <shapespace/files/detail/vtp_document.h>

#include <memory>

#include <expat.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>

namespace shapespace::internal {
namespace {

// Limits of what is stored, since an element takes far more memory than bytes in the file.
constexpr int kMaxElements = 100000;
constexpr int kMaxAttributes = 32;
constexpr size_t kMaxDepth = 16;

class VtpParser {
 public:
  VtpParser(const std::string& file, const std::string& text)
      : file_(file), text_(text), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) throw FileError(file + ": cannot be parsed: out of memory");
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), Begin, End);
    XML_SetCharacterDataHandler(parser_.get(), Characters);
    XML_SetStartDoctypeDeclHandler(parser_.get(), Doctype);
  }

  VtpDocument Parse() {
    const XML_Status status =
        XML_Parse(parser_.get(), text_.data(), static_cast<int>(text_.size()), /*isFinal=*/1);
    if (!problem_.empty()) FailAt(file_, problem_line_, problem_);
    if (status != XML_STATUS_OK && !at_appended_data_) {
      FailAt(file_, Line(),
             std::string("is not well-formed XML: ") +
                 XML_ErrorString(XML_GetErrorCode(parser_.get())) + kReexport);
    }
    return std::move(document_);
  }

 private:
  // Handlers are called by C code, through which no exception may pass. They keep the first
  // problem, and stop the parser.
  static void Begin(void* self, const XML_Char* name, const XML_Char** attributes) {
    static_cast<VtpParser*>(self)->BeginElement(name, attributes);
  }
  static void End(void* self, const XML_Char*) { static_cast<VtpParser*>(self)->open_.pop_back(); }
  static void Characters(void* self, const XML_Char* text, int length) {
    auto* parser = static_cast<VtpParser*>(self);
    if (parser->IsIn("DataArray") && parser->array_ != nullptr) {
      parser->array_->text.append(text, static_cast<size_t>(length));
    }
  }
  static void Doctype(void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    static_cast<VtpParser*>(self)->Stop("has a document type, which .vtp files have not");
  }

  int Line() const { return static_cast<int>(XML_GetCurrentLineNumber(parser_.get())); }

  void Stop(const std::string& problem) {
    if (problem_.empty()) {
      problem_ = problem;
      problem_line_ = Line();
    }
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  bool IsIn(std::string_view name) const { return !open_.empty() && open_.back() == name; }

  void BeginElement(const XML_Char* name, const XML_Char** words) {
    if (++elements_ > kMaxElements || open_.size() >= kMaxDepth) {
      return Stop(open_.size() >= kMaxDepth
                      ? "has elements nested more than " + std::to_string(kMaxDepth) + " deep"
                      : "has more than " + std::to_string(kMaxElements) + " elements");
    }
    XmlAttributes attributes;
    for (int i = 0; i < kMaxAttributes && words[2 * i] != nullptr; ++i) {
      attributes.emplace(words[2 * i], words[2 * i + 1]);
    }
    const std::string section = open_.empty() ? "" : open_.back();
    open_.emplace_back(name);
    array_ = nullptr;
    if (open_.size() == 1) return BeginFile(name, std::move(attributes));
    if (open_.back() == "AppendedData") return BeginAppendedData(attributes);
    if (open_.back() == "FieldData") document_.has_field_data = true;
    if (open_.back() == "Piece") {
      document_.pieces.push_back({std::move(attributes), "", {}, Line()});
    } else if (!document_.pieces.empty() && open_.size() >= 4 && open_[2] == "Piece") {
      VtpDocument::Piece& piece = document_.pieces.back();
      if (open_.back() == "PointData") piece.texture = AttributeOf(attributes, "TCoords");
      if (open_.back() != "DataArray") return;
      piece.arrays.push_back({section, std::move(attributes), "", Line()});
      array_ = &piece.arrays.back();
    }
  }

  void BeginFile(const std::string& name, XmlAttributes attributes) {
    const std::string_view type = AttributeOf(attributes, "type");
    if (name != "VTKFile") return Stop("begins with another element than VTKFile; is this a .vtp?");
    if (type != "PolyData") {
      return Stop("contains " + Quoted(type) +
                  " instead of PolyData; in ParaView, apply the filter Extract Surface and save "
                  "the result as .vtp");
    }
    document_.attributes = std::move(attributes);
  }

  /// The data begin after an underscore, and are no XML: the parser stops here.
  void BeginAppendedData(const XmlAttributes& attributes) {
    document_.appended_as_base64 = AttributeOf(attributes, "encoding") == "base64";
    const auto element = static_cast<size_t>(XML_GetCurrentByteIndex(parser_.get()));
    const size_t end = text_.find('>', element);
    const size_t begin = text_.find('_', std::min(end, text_.size()));
    if (begin == std::string::npos) {
      return Stop("the appended data do not begin with an underscore" + std::string(kReexport));
    }
    document_.appended = std::string_view(text_).substr(begin + 1);
    at_appended_data_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  const std::string& file_;
  const std::string& text_;
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
  VtpDocument document_;
  std::vector<std::string> open_;  // the elements around the current place
  VtpDocument::Array* array_ = nullptr;
  int elements_ = 0;
  bool at_appended_data_ = false;
  std::string problem_;
  int problem_line_ = 0;
};

}  // namespace

VtpDocument ParseVtp(const std::string& file, const std::string& text) {
  return VtpParser(file, text).Parse();
}

}  // namespace shapespace::internal
