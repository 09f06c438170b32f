#ifndef SHAPESPACE_BASE_DETAIL_FILE_BUFFER_H_
#define SHAPESPACE_BASE_DETAIL_FILE_BUFFER_H_

#include <unistd.h>

#include <array>
#include <cerrno>
#include <streambuf>

namespace shapespace::internal {

/// Writes to an open file. Streams of the standard library open files by name only, and so follow
/// links and take files that others have made.
class FileBuffer : public std::streambuf {
 public:
  /// Takes ownership of `descriptor`.
  explicit FileBuffer(int descriptor) : descriptor_(descriptor) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }
  FileBuffer(const FileBuffer&) = delete;
  FileBuffer& operator=(const FileBuffer&) = delete;
  ~FileBuffer() override { Close(); }

  /// Writes what is left and closes the file. Returns whether both succeeded.
  bool Close() {
    if (descriptor_ < 0) return true;
    const bool written = WriteBuffer();
    const bool closed = close(descriptor_) == 0;
    if (!closed && error_ == 0) error_ = errno;
    descriptor_ = -1;
    return written && closed;
  }

  /// Why writing or closing failed for the first time, such as ENOSPC; 0 if neither has.
  int Error() const { return error_; }

 protected:
  int_type overflow(int_type c) override {
    if (!WriteBuffer()) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

  int sync() override { return WriteBuffer() ? 0 : -1; }

  /// For `tellp`; the position cannot be changed.
  pos_type seekoff(off_type offset, std::ios_base::seekdir direction,
                   std::ios_base::openmode) override {
    if (offset != 0 || direction != std::ios_base::cur) return pos_type(off_type(-1));
    return pos_type(written_ + (pptr() - pbase()));
  }

 private:
  bool WriteBuffer() {
    const char* from = pbase();
    while (from < pptr()) {
      const ssize_t count = write(descriptor_, from, static_cast<size_t>(pptr() - from));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        if (error_ == 0) error_ = count < 0 ? errno : EIO;
        return false;
      }
      from += count;
    }
    written_ += pptr() - pbase();
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return true;
  }

  std::array<char, 1 << 16> buffer_;
  int descriptor_, error_ = 0;
  off_type written_ = 0;  // bytes, without those in the buffer
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_DETAIL_FILE_BUFFER_H_
