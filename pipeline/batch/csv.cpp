#include "pipeline/batch/csv.h"

#include "io/error.h"

#include <algorithm>

namespace hsgm::pipeline {

namespace {

std::string trimmed(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) {
        return "";
    }
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Cell by cell through the text.
class Reader {
public:
    Reader(const std::string& text, const std::string& name) : text_(text), name_(name) {}

    std::vector<std::vector<std::string>> rows()
    {
        std::vector<std::vector<std::string>> rows;
        while (at_ < text_.size()) {
            std::vector<std::string> row{cell()};
            while (at_ < text_.size() && text_[at_] == ',') {
                ++at_;
                row.push_back(cell());
            }
            ++at_; // the line's end
            const bool empty = row.size() == 1 && row[0].empty();
            if (!empty && !row[0].starts_with('#')) {
                rows.push_back(std::move(row));
            }
        }
        return rows;
    }

private:
    std::string cell()
    {
        const std::size_t begin = text_.find_first_not_of(" \t", at_);
        if (begin != std::string::npos && text_[begin] == '"') {
            at_ = begin + 1;
            return quoted();
        }
        const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
        const std::string cell = trimmed(text_.substr(at_, end - at_));
        at_ = end;
        return cell;
    }
    std::string quoted()
    {
        std::string cell;
        while (true) {
            const std::size_t end = text_.find('"', at_);
            if (end == std::string::npos) {
                throw io::ConfigError(name_ + ": a quote is begun and not ended: \"" +
                                      text_.substr(at_, 40));
            }
            cell += text_.substr(at_, end - at_);
            at_ = end + 1;
            if (at_ >= text_.size() || text_[at_] != '"') {
                at_ = std::min(text_.find_first_of(",\n", at_), text_.size());
                return cell;
            }
            cell += '"';
            ++at_;
        }
    }

    const std::string& text_;
    const std::string& name_;
    std::size_t at_ = 0;
};

} // namespace

std::vector<std::vector<std::string>> parse_csv(const std::string& text,
                                                const std::string& name)
{
    return Reader(text, name).rows();
}

std::string csv_row(const std::vector<std::string>& cells)
{
    std::string row;
    for (const std::string& cell : cells) {
        row += row.empty() && &cell == &cells.front() ? "" : ",";
        if (cell.find_first_of(",\"\n") == std::string::npos) {
            row += cell;
            continue;
        }
        row += '"';
        for (const char c : cell) {
            row += c == '"' ? std::string("\"\"") : std::string(1, c);
        }
        row += '"';
    }
    return row + "\n";
}

} // namespace hsgm::pipeline
