// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/format_reader.h"

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <fmt/format.h>

#include <memory>
#include <string_view>
#include <vector>

#include "geometry/input_error.h"

namespace arris {

void keep_reader_of(const std::string& extension, Assimp::Importer& importer)
{
    std::vector<Assimp::BaseImporter*> others;
    bool is_kept = false;
    for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
        const aiImporterDesc& about = *importer.GetImporterInfo(i);
        const std::string extensions = fmt::format(" {} ", about.mFileExtensions);
        // Skip the reader of glTF version 1, which is obsolete.
        const bool is_reader = extensions.find(" " + extension + " ") != std::string::npos &&
                               std::string_view(about.mName) != "glTF Importer";
        if (is_reader && !is_kept)
            is_kept = true;
        else
            others.push_back(importer.GetImporter(i));
    }
    if (!is_kept) throw InputError(fmt::format("the import library cannot read .{} files", extension));
    for (Assimp::BaseImporter* other : others) {
        importer.UnregisterLoader(other);
        const std::unique_ptr<Assimp::BaseImporter> owned(other);
    }
}

}  // namespace arris
