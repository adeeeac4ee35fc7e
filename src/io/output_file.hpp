#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace carom::io {

/// A file that is there whole or not at all: what is written goes to `PATH.part`, which takes the place of
/// `PATH` on `finish` and is removed when the object ends before. A device or a pipe is written to as it is.
class OutputFile {
  public:
    /// Opens the file. Throws `Error` "WHAT file 'PATH' cannot be written: reason", as all functions here do.
    OutputFile(const std::filesystem::path& path, std::string_view what);
    ~OutputFile();

    void write(std::string_view text);
    void finish();

  private:
    struct Close {
        void operator()(std::FILE* file) const {
            if (file != stdout) std::fclose(file);
        }
    };
    [[noreturn]] void refuse(int error_number) const;

    std::filesystem::path path_, target_, written_;
    std::string what_;
    std::unique_ptr<std::FILE, Close> file_;
    bool finished_ = false;
};

}  // namespace carom::io
