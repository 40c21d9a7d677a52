// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the JSON schema of CITATION.cff 1.2.0, which the package cffjs brings: node cff_schema.js
'use strict';

const path = require('path');
const { pathToFileURL } = require('url');

const file = path.join(process.env.NODE_PATH, 'cffjs', 'dist', 'schema.js');
import(pathToFileURL(file)).then(({ schema }) => console.log(JSON.stringify(schema)));
