// Prints the hashes of the fits that the core computes in WebAssembly. Fails if a hash differs from the expected one.
// `cargo xtask ci` runs `node hash.mjs shadowfit_determinism.wasm`.
import { readFileSync } from 'node:fs';

const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), {});
const {
    shadowfit_hash, shadowfit_expected_hash, shadowfit_numbers, shadowfit_expected_numbers,
} = instance.exports;
const hex = (value) => `0x${BigInt.asUintN(64, value).toString(16)}`;
for (const [name, hash, expected] of [
    ["the fits' hash", shadowfit_hash(), shadowfit_expected_hash()],
    ...['single map', 'cascades', 'windows'].map((kind, index) => [
        `the hash over the numbers of ${kind}`, shadowfit_numbers(index), shadowfit_expected_numbers(index),
    ]),
]) {
    if (hash !== expected) {
        console.error(`${name} is ${hex(hash)} in WebAssembly, but ${hex(expected)} elsewhere`);
        process.exit(1);
    }
    console.log(`${name} is ${hex(hash)} in WebAssembly too`);
}
