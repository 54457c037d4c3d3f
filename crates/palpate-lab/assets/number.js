// Numbers as people write them.

const PLAIN = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const THOUSANDS = /^[+-]?[1-9]\d*,\d{3}$/;

// The number that a text says, with a point or a decimal comma: `{ value }`, or `{ wrong }`, a sentence, where it says none or can be read
// in two ways: “1,000” is a thousand to some and one to others.
export const decimal = (text) => {
  const written = text.trim().replace("−", "-");
  if (THOUSANDS.test(written)) {
    const [thousand, one] = [written.replace(",", ""), written.replace(",", ".")];
    return { wrong: `“${text.trim()}” can be read as ${+thousand} and as ${+one}: write ${thousand} or ${one}` };
  }
  const commas = written.split(",").length - 1;
  if (commas > 1 || (commas === 1 && written.includes("."))) return { wrong: `“${text.trim()}” mixes separators: write one decimal point and no separator of thousands, such as 1234.5` };
  const pointed = written.replace(",", ".");
  if (!PLAIN.test(pointed)) return { wrong: `expected a number such as 12.5, found “${text.trim()}”` };
  return { value: Number(pointed) };
};
