// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an IFC file with web-ifc and prints as JSON what it finds: storeys, and for each product its class, name,
// the structure or wall it belongs to, size, properties and the box of its triangles, openings cut, in metres with
// z up: node read_ifc.js FILE.ifc
'use strict';

const fs = require('fs');
const ifc = require('web-ifc');

const kClasses = ['IFCWALL', 'IFCOPENINGELEMENT', 'IFCDOOR', 'IFCWINDOW', 'IFCSPACE', 'IFCFURNITURE', 'IFCCOLUMN',
  'IFCCOVERING', 'IFCBUILDINGELEMENTPROXY', 'IFCSENSOR', 'IFCAUDIOVISUALAPPLIANCE'];

const valueOf = (item) => (item === null || item === undefined ? null : item.value);

/// Box and volume of an element's triangles.
function shapeOf(api, model, id) {
  const shape = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity], volume: 0 };
  let triangles = 0;
  const mesh = api.GetFlatMesh(model, id);
  for (let part = 0; part < mesh.geometries.size(); ++part) {
    const placed = mesh.geometries.get(part);
    const m = placed.flatTransformation;
    const geometry = api.GetGeometry(model, placed.geometryExpressID);
    const vertices = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());
    const indices = api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
    const corners = Array.from(indices, (index) => {
      const [x, y, z] = vertices.subarray(6 * index, 6 * index + 3);
      const row = (k) => m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k];
      return [row(0), -row(2), row(1)];  // y is up there
    });
    for (const corner of corners)
      corner.forEach((value, axis) => {
        shape.low[axis] = Math.min(shape.low[axis], value);
        shape.high[axis] = Math.max(shape.high[axis], value);
      });
    for (let i = 0; i < corners.length; i += 3) {
      const [a, b, c] = corners.slice(i, i + 3);
      shape.volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
        a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
      ++triangles;
    }
  }
  return triangles === 0 ? null : shape;
}

async function main() {
  const api = new ifc.IfcAPI();
  await api.Init();
  const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
  const model = api.OpenModel(bytes);
  if (model < 0 || api.GetModelSchema(model) !== 'IFC4') throw new Error('no IFC4 model');
  const linesOf = (type) => Array.from(api.GetLineIDsWithType(model, ifc[type]), (id) => api.GetLine(model, id));
  const idsOf = (items) => [].concat(items).map((item) => item.value);

  const found = { guids: [], storeys: [], products: {} };
  const belongs = new Map();
  const relate = (type, whole, parts) => {
    for (const relation of linesOf(type))
      for (const id of idsOf(relation[parts])) belongs.set(id, relation[whole].value);
  };
  relate('IFCRELAGGREGATES', 'RelatingObject', 'RelatedObjects');
  relate('IFCRELCONTAINEDINSPATIALSTRUCTURE', 'RelatingStructure', 'RelatedElements');
  relate('IFCRELVOIDSELEMENT', 'RelatingBuildingElement', 'RelatedOpeningElement');
  const fills = new Map();
  for (const relation of linesOf('IFCRELFILLSELEMENT'))
    fills.set(relation.RelatedBuildingElement.value, relation.RelatingOpeningElement.value);
  const properties = new Map();
  for (const relation of linesOf('IFCRELDEFINESBYPROPERTIES')) {
    const set = api.GetLine(model, relation.RelatingPropertyDefinition.value, true);
    const values = {};
    for (const item of set.HasProperties || []) values[item.Name.value] = valueOf(item.NominalValue);
    for (const item of set.Quantities || [])
      values[item.Name.value] = valueOf(item.AreaValue || item.LengthValue);
    for (const id of idsOf(relation.RelatedObjects)) properties.set(id, { set: set.Name.value, ...values });
  }
  const nameOf = (id) => (id === undefined ? null : valueOf(api.GetLine(model, id).Name));
  for (const storey of linesOf('IFCBUILDINGSTOREY'))
    found.storeys.push({
      name: valueOf(storey.Name), elevation: valueOf(storey.Elevation), in: nameOf(belongs.get(storey.expressID)) });
  for (const type of kClasses)
    for (const product of linesOf(type)) {
      const id = product.expressID;
      const row = { class: type.slice(3).toLowerCase(), kind: valueOf(product.PredefinedType),
        object_type: valueOf(product.ObjectType), in: nameOf(belongs.get(id)), shape: shapeOf(api, model, id) };
      if (fills.has(id)) row.fills = nameOf(fills.get(id));
      if (product.OverallHeight) row.size = [valueOf(product.OverallWidth), valueOf(product.OverallHeight)];
      if (properties.has(id)) row.properties = properties.get(id);
      (found.products[valueOf(product.Name)] ??= []).push(row);
    }
  for (const line of api.GetAllLines(model)) {
    const guid = valueOf(api.GetLine(model, line).GlobalId);
    if (guid) found.guids.push(guid);
  }
  console.log(JSON.stringify(found));
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
