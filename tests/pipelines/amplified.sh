#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Small files that ask for minutes of work: an answer, or one error with the way out, within two seconds
# of processor time; within three here, since cores that other programs share count more.
. "$(dirname "$0")/common.sh"

amplify() { python3 "$source_dir/tests/torture/amplify.py" "$@"; }

# quick FAMILY BYTES: the answer of envc to such a file comes in time.
quick() {
    local operand
    status=0
    operand=$(amplify write "$1" "$2" "$1")
    (ulimit -t 3 && exec envc --info "$operand") >out 2>err || status=$?
    [ "$status" -le 1 ] || fail "status $status of $1 with $2 bytes: $(tail -n 1 err)"
}

# refused FAMILY BYTES POSITION: one error with that position, which names the option that allows more.
refused() {
    quick "$1" "$2"
    [ "$status" -eq 1 ] || fail "$1 with $2 bytes is not refused"
    [ "$(wc -l <err)" -eq 1 ] || fail "not one error for $1: $(cat err)"
    grep -q "$3:[0-9:]* error: .* make.* more than [0-9]* units of work (\`--max-work [0-9]*\` allows more)" err ||
        fail "another error for $1: $(cat err)"
}

refused dxf_missing 60000 plan.dxf
refused dxf_missing_nested 60000 plan.dxf
refused dxf_empty_block 60000 plan.dxf
refused dxf_empty_polylines 60000 plan.dxf
refused dxf_circles_of_nothing 60000 plan.dxf
refused dxf_crossing 120000 plan.dxf
refused dxf_drawn_crossing 120000 plan.dxf
quick dxf_drawn_outline 900000
quick dxf_crossing 40000
quick dxf_crossing_blocks 2000
quick dxf_crossing_blocks 60000
refused svg_use_text 15000 plan.svg
refused svg_use_hidden 15000 plan.svg
refused svg_use_unknown 15000 plan.svg
refused svg_use_empty 15000 plan.svg
refused sdf_same 400000 model.sdf
refused sdf_nested 4000 model.sdf
refused yaml_parts 15000 room.yaml
refused yaml_repeats 15000 room.yaml
refused house_rooms 15000 'r[0-9]*.yaml'
refused house_inline 15000 house.yaml
refused rmf_aliases 16000 house.building.yaml
refused ifc_levels 400000 house.ifc
for family in curves profiles booleans; do refused ifc_$family 6000 house.ifc; done
refused ifc_shells 60000 house.ifc
refused ifc_long_points 200000 house.ifc
quick ifc_maps 60000
quick ifc_point_lists 400000

# Done once, or in one pass.
quick svg_style 89000
quick svg_transform 89000
quick svg_classes 89000
quick svg_rules 89000
quick svg_long_ids 89000
quick svg_css_comments 2000000
quick svg_css_selectors 400000
quick sdf_same 12000
quick ifc_storeys 4000000
quick ifc_mapped_walls 20000
quick ifc_mapped_walls 400000
quick ifc_shared_walls 70000
quick ifc_shared_walls 400000
quick ifc_mappings 400000
grep -q ': error: #[0-9]*: mapped shapes make more than [0-9]* units of work' err || fail "another error: $(cat err)"
quick gltf_instances 400000
grep -q 'nodes that repeat meshes make more than [0-9]* units of work' err || fail "another error: $(cat err)"
quick env_coincident_things 800000
quick env_calibrations 200000
quick env_bad_meshes 200000
for family in env_comb env_comb_zone pol_comb pol_star pol_holes; do
    quick "$family" 800000
done
for family in house_aliases house_passages house_unknown rmf_fiducials; do
    quick "$family" 90000
done
for family in batch_jobs batch_words batch_quotes; do
    list=$(amplify write "$family" 90000 "$family")
    for command in "coverage --batch" "scan -o outputs/ --batch" "arrange -o outputs/ --sensor laser:1 --batch"; do
        status=0
        # shellcheck disable=SC2086
        (ulimit -t 3 && exec $command "$list") >out 2>err || status=$?
        [ "$status" -eq 1 ] || fail "status $status of $command with $family: $(tail -n 1 err)"
    done
done
refused sdf_apart 60000 model.sdf

# The bound is lifted and lowered.
printf '#env 1\nispace size=4,4\n' >room.env
expect_status 0 envc room.env --max-work none
amplify write dxf_coincident 4000 drawing >operand
expect_status 0 envc --info "$(cat operand)"
expect_error 1 envc --info --max-work 10 "$(cat operand)"
grep -q 'more than 10 units of work (`--max-work 20` allows more)' err || fail "another error: $(cat err)"
# Each tool that reads rooms takes the option.
room=$(amplify write yaml_repeats 2000 room)
for command in "arrange $room --sensor laser:1 --strategy grid -X 2 -Y 2" "scan $room --model laser --poses /dev/null" "coverage $room $data/robots.3dm" \
    "simrun $room --until 0" "envc $room --info"; do
    # shellcheck disable=SC2086
    expect_error 1 $command --max-work 500
    grep -q 'more than 500 units of work (`--max-work 1000` allows more)' err || fail "another error of $command: $(cat err)"
done
for value in 0 -1 1.5 many 99999999999999999999; do
    expect_error 2 envc room.env --max-work "$value"
done
