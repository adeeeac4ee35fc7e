#include "io/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "carom/error.hpp"

namespace carom::io {

namespace fs = std::filesystem;

OutputFile::OutputFile(const fs::path& path, std::string_view what)
    : path_(path), target_(path), written_(path), what_(what) {
    if (path == "/dev/stdout") {
        // Where the standard output goes to a file, opening that again would wipe out what stands in it.
        file_.reset(stdout);
        return;
    }
    std::error_code error;
    if (fs::is_symlink(path, error)) {
        // The file that the link leads to is replaced, not the link.
        const fs::path end = fs::weakly_canonical(path, error);
        if (!error) target_ = written_ = end;
    }
    if (fs::is_directory(target_, error)) refuse(EISDIR);
    if (!fs::exists(target_, error) || fs::is_regular_file(target_, error)) written_ += ".part";
    file_.reset(std::fopen(written_.string().c_str(), "wb"));
    if (!file_) refuse(errno);
    std::setvbuf(file_.get(), nullptr, _IOFBF, 1u << 20);
}

OutputFile::~OutputFile() {
    file_.reset();
    std::error_code error;
    if (!finished_ && written_ != target_) fs::remove(written_, error);
}

void OutputFile::write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) refuse(errno);
}

void OutputFile::finish() {
    if (std::fflush(file_.get()) != 0) refuse(errno);
    std::FILE* file = file_.release();
    if (file != stdout && std::fclose(file) != 0) refuse(errno);
    if (written_ != target_) {
        std::error_code error;
        fs::rename(written_, target_, error);
        if (error) refuse(error.value());
    }
    finished_ = true;
}

void OutputFile::refuse(int error_number) const {
    throw Error(fmt::format("{} file '{}' cannot be written: {}", what_, path_.string(),
                            std::generic_category().message(error_number)));
}

}  // namespace carom::io
