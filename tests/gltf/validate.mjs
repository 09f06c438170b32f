// Prints what the Khronos glTF validator says of each file named; fails if it has any error or
// warning. run.sh installs the package that this needs.
import { readFileSync } from 'node:fs';
import { validateBytes } from 'gltf-validator';

const severities = ['error', 'warning', 'information', 'hint'];
let bad = 0;
for (const file of process.argv.slice(2)) {
  try {
    const { issues, info } = await validateBytes(new Uint8Array(readFileSync(file)));
    const { totalVertexCount, totalTriangleCount, animationCount } = info ?? {};
    console.log(
      `${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ` +
        `${issues.numInfos + issues.numHints} remarks; ${totalVertexCount} vertices, ` +
        `${totalTriangleCount} triangles, ${animationCount} animations`,
    );
    for (const { severity, code, message, pointer } of issues.messages) {
      console.log(`  ${severities[severity]} ${code} ${pointer ?? ''}: ${message}`);
    }
    if (issues.numErrors + issues.numWarnings > 0) ++bad;
  } catch (error) {
    // It is no glTF at all, or cannot be read.
    console.log(`${file}: ${error.message ?? error}`);
    ++bad;
  }
}
if (bad > 0) {
  console.error(`gltf test: ${bad} files have errors or warnings`);
  process.exit(1);
}
console.log('gltf test: passed');
