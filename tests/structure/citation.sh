#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# CITATION.cff keeps to the schema of the Citation File Format. `make check` fetches the schema.
. "$(dirname "$0")/../pipelines/common.sh"

command -v node >/dev/null || skip "no node here"
[ -d "$binary_dir/npm/node_modules/cffjs" ] || skip "npm could not fetch the schema"
python3 -c 'import jsonschema, yaml' 2>/dev/null || skip "no jsonschema and yaml for Python here"
NODE_PATH=$binary_dir/npm/node_modules node "$source_dir/tests/npm/cff_schema.js" >schema.json

# Dates are text in JSON, and in YAML without quotes they are not.
holds() {
    python3 - schema.json "$1" <<'END'
import json, sys
import jsonschema, yaml
with open(sys.argv[1]) as file:
    schema = json.load(file)
with open(sys.argv[2]) as file:
    citation = yaml.load(file, yaml.BaseLoader)
errors = [error.message for error in jsonschema.Draft7Validator(schema).iter_errors(citation)]
sys.exit("\n".join(errors) or 0)
END
}
holds "$source_dir/CITATION.cff" || fail "CITATION.cff is not as the schema wants it"

# The test can fail: without a title, with a licence that SPDX does not know, with a key of nobody's.
for edit in '/^title:/d' 's/^license:.*/license: GPL-3/' 's/^keywords:/words:/'; do
    sed "$edit" "$source_dir/CITATION.cff" >other.cff
    if holds other.cff 2>/dev/null; then fail "self-test: it passes after $edit"; fi
done
